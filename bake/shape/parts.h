// A mesh taken apart: triangles that hang together by edges, where equal positions are one vertex, and that are taken
// for the same.
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
    std::vector<std::uint32_t> triangles;  ///< indices, ascending
    bool closed = true;                    ///< no edge is one of an odd number of triangles
    bool balanced = true;                  ///< every edge runs as often one way as the other
    bool manifold = true;                  ///< every edge is one of two triangles
};

/// In the order of their lowest triangles.
/// \param kinds  what each triangle is taken for; empty: all for the same. An edge between two kinds is the border of
///               both.
[[nodiscard]] std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges,
                                        std::span<const ShapeAs> kinds = {});

/// Triangles that lie where an earlier one of their part does, either way round, if the part is closed without them: more
/// copies of a solid, or of a piece of one. Two sides of a fin are none, for without one of them its part is open.
/// \param welded  of the mesh (mesh_edges.h).
/// \return indices, ascending.
[[nodiscard]] std::vector<std::uint32_t> copiesInSolids(const TriangleMesh& mesh,
                                                        std::span<const std::uint32_t> welded,
                                                        std::span<const Part> parts);

/// What closed triangles enclose, negative if they look inwards. nullopt: nothing, as a sheet with two sides does.
/// \param center  of the mesh, where sums lose least.
[[nodiscard]] std::optional<double> enclosedVolume(const std::vector<glm::vec3>& positions,
                                                   const std::vector<glm::uvec3>& triangles,
                                                   const glm::dvec3& center);

}  // namespace relief
