// SPDX-License-Identifier: Apache-2.0
// Splits a mesh into parts that are connected by edges and of one kind, and finds copies among them. Equal positions
// count as one vertex.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
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

/// Returns the parts, ordered by their first triangle.
/// \param kinds  per triangle; empty: all of one kind. An edge between two kinds is a border of both.
[[nodiscard]] std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges,
                                        std::span<const ShapeAs> kinds = {});

/// Finds triangles that coincide with an earlier one of their part, in either winding, if the part is closed without
/// them: copies of a solid, or of a piece of it. Omits the back of a two-sided fin, without which the part would
/// be open.
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

/// Maximum distance between near copies, as a fraction of the larger part's longest side. Equals the
/// minimum thickness of a shell, as a fraction of the longest side of its sheet, in checkShellThickness().
inline constexpr double kCopyReach = 1e-4;

struct NearCopies {
    std::vector<std::uint32_t> triangles;  ///< of all parts except the largest of each group, ascending
    std::uint64_t parts = 0;               ///< number of parts of these triangles
    /// Largest distance from a corner to the nearest corner of the kept part, object units.
    double farthest = 0.0;

    /// Returns the warning: "2 closed parts lie within 1e-06 of another …".
    [[nodiscard]] std::string text() const;
};

/// Finds closed parts that almost coincide with another part, as in an export of two copies, one enlarged by a
/// millionth. The gap between them is thinner than any wall of a collider and would make the solid hollow. In near
/// copies, every corner lies within kCopyReach (times the longest side) of a corner of the other part.
/// \param solids  closed, not flat; borrowed.
[[nodiscard]] NearCopies nearCopies(const TriangleMesh& mesh, std::span<const Part* const> solids);

}  // namespace relief
