// Colours and pictures of figures.
#pragma once

#include <cstdint>
#include <vector>

namespace relief {

/// sRGB, each in [0, 1].
struct Color {
    double r, g, b;
};

inline constexpr Color kInsideColor{0.23, 0.29, 0.38};
inline constexpr Color kOutsideColor{0.94, 0.945, 0.95};

/// Ottosson, "A perceptual color space for image processing" (2020). Hue in degrees; clamped to sRGB.
[[nodiscard]] Color fromOklch(double lightness, double chroma, double hue);

/// Diverging: lightness falls evenly with |u|, blue inside and orange outside, legible in print and to the colour-blind.
/// \param u  distance over its largest shown value, clamped to [−1, 1].
[[nodiscard]] Color distanceColor(double u);

/// 0xRRGGBB
[[nodiscard]] std::uint32_t toPixel(const Color& c);

struct RgbImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint32_t> pixels;  ///< 0xRRGGBB, row by row from the top
};

}  // namespace relief
