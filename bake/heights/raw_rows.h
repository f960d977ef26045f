// SPDX-License-Identifier: Apache-2.0
// Raw samples without a header: their type, byte order and width are settings, as nothing in the file states them.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "bake/heights/heights_spec.h"
#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file's name: kInvalidInput (no such rows, or no square).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openRawRows(std::span<const std::byte> bytes,
                                                              const HeightsSpec& spec);

/// Returns the settings type and order that fit the samples better than those of `spec`: "order=big". Empty if there are none.
/// Compares the differences of neighbours in at most 64 rows, and the values of all bytes.
[[nodiscard]] std::string likelierRawFormat(std::span<const std::byte> bytes, const HeightsSpec& spec);

}  // namespace relief
