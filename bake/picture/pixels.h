// Pictures drawn pixel by pixel.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/picture/color.h"

namespace relief {

/// A picture of colorAt(x, y), on all cores.
template <class ColorAt>
[[nodiscard]] RgbImage drawPixels(std::uint32_t width, std::uint32_t height, const ColorAt& colorAt) {
    RgbImage image{width, height, std::vector<std::uint32_t>(std::size_t{width} * height)};
    tbb::parallel_for(std::uint32_t{0}, height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            image.pixels[std::size_t{y} * width + x] = toPixel(colorAt(x, y));
        }
    });
    return image;
}

}  // namespace relief
