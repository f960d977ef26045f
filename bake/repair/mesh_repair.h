// Wraps of meshes, and their self-intersections, by CGAL, whose exceptions become errors.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

struct SelfIntersections {
    std::uint64_t pairs = 0;           ///< of triangles
    std::uint32_t first_triangle = 0;  ///< the lowest that is part of a pair
};

/// Limit of pairs of triangles with overlapping boxes.
inline constexpr std::uint64_t kIntersectionCandidateMax = 200'000'000;

/// Pairs of triangles that meet elsewhere than in common vertices (equal positions are one) and edges, by exact predicates.
/// Duplicates do not count. Single-threaded: about 1 s for 100,000 triangles.
/// Errors: kLimit (kIntersectionCandidateMax), kFailure.
[[nodiscard]] Result<SelfIntersections> selfIntersections(const TriangleMesh& mesh);

inline constexpr double kWrapAlphaMin = 0.001;
inline constexpr double kWrapAlphaMax = 0.5;

/// A surface shrunk round the mesh that does not enter holes smaller than alpha: closed, manifold, wound outwards, without
/// intersections, with the whole mesh inside, its vertices a thirtieth of alpha off it. Portaneri, Rouxel-Labbe, Hemmer,
/// Cohen-Steiner and Alliez, "Alpha wrapping with an offset" (2022). Name, hash and unit stay; the bounds grow by the offset.
/// Time and triangles grow with the surface over alpha squared: 60,000 triangles and 15 s for a bunny at 0.01. The same bytes
/// each time, on one thread.
/// \param alpha  in units of the mesh's longest side, in [kWrapAlphaMin, kWrapAlphaMax].
/// Errors: kUsage (alpha), kLimit (out of memory), kFailure.
[[nodiscard]] Result<TriangleMesh> wrapMesh(const TriangleMesh& mesh, double alpha);

}  // namespace relief
