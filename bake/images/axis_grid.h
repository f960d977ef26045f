// SPDX-License-Identifier: Apache-2.0
// A grid of image samples perpendicular to an object-space axis: a slice, or the window of an orthographic view.
//
// Images are oriented like orthographic maps (bake/views/view.h): +y is up, or ±z for views along ±y.
//
//     view            +x    -x    +y    -y    +z    -z
//     to the right    +z    -z    +x    +x    -x    +x
//     up              +y    +y    +z    -z    +y    +y
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "bake/images/exr.h"
#include "formats/base/result.h"
#include "formats/collider.h"

namespace relief {

/// Names by view: 2 · axis, plus 1 for the negative direction. Also the order of the faces of a cube.
inline constexpr std::array<const char*, 6> kDirectionNames{"+x", "-x", "+y", "-y", "+z", "-z"};

struct AxisGrid {
    int view = 0;   ///< index of kDirectionNames
    int right = 2;  ///< axis along the rows of the image, in either direction
    int up = 1;
    std::uint32_t width = 0;  ///< samples
    std::uint32_t height = 0;
    glm::dvec2 corner{
        0.0};  ///< minimum coordinates of the area along `right` and `up`, half a sample before the first sample
    double spacing = 1.0;  ///< object units between samples

    [[nodiscard]] int axis() const { return view / 2; }
    [[nodiscard]] double sign() const { return view % 2 == 0 ? 1.0 : -1.0; }
    /// \param x, y  sample from the left and from the bottom.
    /// \param at  coordinate along the axis, object units.
    [[nodiscard]] glm::vec3 point(std::uint32_t x, std::uint32_t y, float at) const;
    /// The index of a sample in an image whose first row is at the top.
    [[nodiscard]] std::size_t pixel(std::uint32_t x, std::uint32_t y) const {
        return std::size_t{height - 1 - y} * width + x;
    }
    /// Returns an image of these samples, zero in all channels, with a camera and the attributes view, unit and bounds.
    /// \param near  position of the camera along the axis, object units.
    [[nodiscard]] ExrImage image(double near, const Collider& collider,
                                 const std::vector<std::string>& channels) const;

  private:
    [[nodiscard]] bool leftwards() const { return view == 1 || view == 4; }
    [[nodiscard]] bool downwards() const { return view == 3; }
};

/// Makes a grid of square samples, centred on the bounds.
/// \param size    samples along the longer side; 2 or more.
/// \param margin  around the bounds, as a fraction of their longer side perpendicular to the axis.
/// Errors: kInvalidInput (bounds too large for floats).
[[nodiscard]] Result<AxisGrid> gridAcross(const Bounds& bounds, int view, std::uint32_t size, double margin);

}  // namespace relief
