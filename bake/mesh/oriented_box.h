// The box of (nearly) the least volume round a mesh, turned as it likes. Its axes are those that many parts
// are built along, however they lie in their file. By CGAL's oriented_bounding_box (Chang, Gorissen and
// Melchior 2011).
#pragma once

#include <array>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/vertex_blocks.h"

namespace relief {

/// The vertices that lie farthest along 146 fixed directions, each once, in the order of their indices: few,
/// whatever the mesh, and among them the corners of all that has flat sides. Object space.
[[nodiscard]] std::vector<glm::dvec3> extremeVertices(const VertexBlocks& vertices);

/// The axes of the box round these points: right-handed, of unit length to rounding, the longest side's
/// first. Components that differ from 0 by rounding alone are 0. nullopt: the points lie (nearly) in a plane,
/// where no box has the least volume, or CGAL gave up. The same points give the same bits: its random numbers
/// start from a fixed seed, and it runs on one thread.
[[nodiscard]] std::optional<std::array<glm::dvec3, 3>> orientedBoxAxes(std::span<const glm::dvec3> points);

/// Of the extreme vertices.
struct OrientedBox {
    std::vector<glm::dvec3> corners;  ///< those vertices
    std::array<glm::dvec3, 3> axes;
};
/// nullopt: as above.
[[nodiscard]] std::optional<OrientedBox> orientedBox(const VertexBlocks& vertices);

}  // namespace relief
