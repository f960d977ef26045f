// SPDX-License-Identifier: Apache-2.0
// Splits a mesh into parts that are connected by edges and of one kind. Equal positions count as one vertex.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/shape/shape_options.h"

namespace relief {

struct Part {
    std::vector<std::uint32_t> triangles;  ///< ascending
    bool closed = true;                    ///< no edge has an odd number of triangles
    bool balanced = true;                  ///< every edge is used equally often in both directions
    bool manifold = true;                  ///< every edge has two triangles
};

/// Returns the parts, ordered by lowest triangle.
/// \param kinds  per triangle; empty: all of one kind. An edge between two kinds is a border of both.
[[nodiscard]] std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges,
                                        std::span<const ShapeAs> kinds = {});

/// Finds triangles that coincide with an earlier one of their part, in either winding, if the part is closed without
/// them: copies of a solid, or of a piece of it. Keeps the second side of a fin, because its part would be open without
/// it.
/// \param welded  weldedVertices() of the mesh.
/// \return indices, ascending.
[[nodiscard]] std::vector<std::uint32_t> copiesInSolids(const TriangleMesh& mesh,
                                                        std::span<const std::uint32_t> welded,
                                                        std::span<const Part> parts);

/// Computes the volume of closed triangles, negative if they face inwards. nullopt if there is none, as for a two-sided
/// sheet.
/// \param center  of the mesh; improves the precision of sums.
[[nodiscard]] std::optional<double> enclosedVolume(const std::vector<glm::vec3>& positions,
                                                   const std::vector<glm::uvec3>& triangles,
                                                   const glm::dvec3& center);

}  // namespace relief
