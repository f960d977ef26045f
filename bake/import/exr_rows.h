// SPDX-License-Identifier: Apache-2.0
// Reads single-channel EXR images row by row.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

/// Opens an EXR image.
/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file name: kInvalidInput (OpenEXR's message), kUnsupported (several channels or parts).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openExrRows(std::span<const std::byte> bytes);

}  // namespace relief
