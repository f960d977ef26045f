// Pictures as PNG bytes. The only file that uses libpng is png.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/result.h"

namespace relief {

/// 8-bit RGB, sRGB, no interlace, no time or text in it: the same pixels give the same bytes.
/// \param rgb     3 · width · height bytes, tightly packed, the top row first.
/// \param width, height  1…65535.
/// Errors: kUsage (size and pixels do not match), kFailure (libpng's words).
[[nodiscard]] Result<std::vector<std::byte>> encodePng(std::span<const std::uint8_t> rgb, std::uint32_t width,
                                                       std::uint32_t height);

}  // namespace relief
