// SPDX-License-Identifier: Apache-2.0
// Reads grey PNG images of any size row by row. Only png_rows.cpp and runtime/files/png.cpp use libpng.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "bake/import/sample_rows.h"
#include "formats/base/result.h"

namespace relief {

/// Opens a PNG image. A colour that the tRNS chunk makes transparent is a hole.
/// \param bytes  untrusted; must outlive the rows.
/// Errors, without the file name: kInvalidInput (libpng's message), kUnsupported (a palette, fewer than 8 bits,
/// interlacing); reading a row also kUnsupported (red, green and blue that differ, alpha that is not opaque).
[[nodiscard]] Result<std::unique_ptr<SampleRows>> openPngRows(std::span<const std::byte> bytes);

}  // namespace relief
