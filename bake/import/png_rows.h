// SPDX-License-Identifier: Apache-2.0
// Grey PNG images row by row, however large they are; beside runtime/files/png.cpp the only user of libpng.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

/// \param bytes  untrusted; must outlive the rows. A colour that the chunk tRNS makes transparent is a hole.
/// Errors, without the file's name: kInvalidInput (libpng's words), kUnsupported (a palette, fewer than 8 bits, interlaced);
/// of a row kUnsupported, too (red, green and blue that differ, alpha that is not opaque).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openPngRows(std::span<const std::byte> bytes);

}  // namespace relief
