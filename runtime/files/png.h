// SPDX-License-Identifier: Apache-2.0
// Encodes and decodes PNG. Only png.cpp and bake/import use libpng.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Encodes 8-bit sRGB without interlacing, time or text. Equal pixels give equal bytes.
/// \param rgb     3 · width · height bytes, tightly packed, top row first.
/// \param width, height  1…65535.
/// Errors: kUsage (size and pixels do not match), kFailure (message of libpng).
[[nodiscard]] Result<std::vector<std::byte>> encodePng(std::span<const std::uint8_t> rgb, std::uint32_t width,
                                                       std::uint32_t height);

struct RgbaPicture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba;  ///< 4 · width · height bytes, sRGB, straight alpha, top row first
};

inline constexpr std::uint32_t kPngReadSideMax = 8192;

/// Decodes an untrusted PNG to 8-bit RGBA.
/// \param name  file name for messages.
/// Errors: kInvalidInput (message of libpng), kLimit (a side above kPngReadSideMax).
[[nodiscard]] Result<RgbaPicture> decodePng(std::span<const std::byte> bytes, std::string_view name);

}  // namespace relief
