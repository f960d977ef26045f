// SPDX-License-Identifier: Apache-2.0
// Pictures as PNG bytes. png.cpp uses libpng; beside it only bake/import does, for height maps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// 8-bit RGB, sRGB, no interlace, no time or text in it: the same pixels give the same bytes.
/// \param rgb     3 · width · height bytes, tightly packed, the top row first.
/// \param width, height  1…65535.
/// Errors: kUsage (size and pixels do not match), kFailure (libpng's words).
[[nodiscard]] Result<std::vector<std::byte>> encodePng(std::span<const std::uint8_t> rgb, std::uint32_t width,
                                                       std::uint32_t height);

struct RgbaPicture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 · width · height bytes, sRGB, straight alpha, the top row first
};

inline constexpr std::uint32_t kPngReadSideMax = 8192;

/// Any PNG as 8-bit RGBA. The bytes are untrusted.
/// \param name  stands for the file in messages.
/// Errors: kInvalidInput (libpng's words), kLimit (a side above kPngReadSideMax).
[[nodiscard]] Result<RgbaPicture> decodePng(std::span<const std::byte> bytes, std::string_view name);

}  // namespace relief
