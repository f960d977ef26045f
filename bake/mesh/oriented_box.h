// SPDX-License-Identifier: Apache-2.0
// The oriented bounding box of least volume. Many parts are built along its axes, however they lie in their file.
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/vertex_blocks.h"

namespace relief {

/// The distinct vertices farthest along 146 fixed directions, by index: few for any mesh, and among them the corners of
/// whatever has flat sides. Object space.
[[nodiscard]] std::vector<glm::dvec3> extremeVertices(const VertexBlocks& vertices);

/// The axes of the box round these points: right-handed, of unit length to rounding, the longest side's first. Components
/// that differ from 0 only by rounding are 0. The same points give the same bits. The time grows with the cube of their
/// number.
/// \return nullopt for points (nearly) in a plane, where the least volume is undefined.
[[nodiscard]] std::optional<std::array<glm::dvec3, 3>> orientedBoxAxes(std::span<const glm::dvec3> points);

struct OrientedBox {
    std::vector<glm::dvec3> corners;  ///< extremeVertices
    std::array<glm::dvec3, 3> axes;   ///< orientedBoxAxes of them
};
[[nodiscard]] std::optional<OrientedBox> orientedBox(const VertexBlocks& vertices);

}  // namespace relief
