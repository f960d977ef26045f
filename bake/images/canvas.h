// SPDX-License-Identifier: Apache-2.0
// Draws an image in memory, in pixels from its upper left corner. No other code uses Cairo.
#pragma once

#include <cairo.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <memory>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// sRGB, each in [0, 1].
using Color = glm::dvec3;

inline constexpr Color kInk{0.13, 0.14, 0.16};

class Canvas {
  public:
    /// Makes a white image. \param em  size of its text, pixels
    Canvas(double width, double height, double em);

    void fill(double x, double y, double width, double height, const Color& color);
    /// \param x, y  start of the baseline
    void text(double x, double y, const std::string& words);
    [[nodiscard]] double textWidth(const std::string& words) const;
    void circle(double x, double y, double radius, double line, const Color& color);
    /// \param color  returns the colour of a pixel (column, row), from the upper left.
    /// \param zoom  canvas pixels per pixel of the drawn image, with sharp edges
    void image(double x, double y, std::uint32_t width, std::uint32_t height, double zoom,
               const std::function<Color(std::uint32_t, std::uint32_t)>& color);
    /// Encodes the image. Errors: kFailure with Cairo's message.
    [[nodiscard]] Result<std::vector<std::byte>> png();

  private:
    std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
    std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context_;
};

}  // namespace relief
