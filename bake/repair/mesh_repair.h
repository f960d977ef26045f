// Repair of meshes and detection of self-intersections, by CGAL. CGAL's preconditions are checked before the calls, and its
// exceptions become errors.
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

/// The mesh wound consistently across edges of two triangles and split at all others: positions of such edges and of vertices
/// where surfaces only touch are repeated. The outer side is left to winding.h. Drops duplicate triangles.
/// Errors: kFailure.
[[nodiscard]] Result<TriangleMesh> orientMesh(const TriangleMesh& mesh);

/// Edges of the largest hole that fillHoles triangulates.
inline constexpr std::size_t kHoleEdgesMax = 2000;

struct HoleFill {
    TriangleMesh mesh;
    std::uint64_t filled = 0;     ///< holes
    std::uint64_t triangles = 0;  ///< that fill them, at the end of the mesh
    std::uint64_t left = 0;       ///< holes beyond kHoleEdgesMax, or for which CGAL found no patch
};

/// Fills every hole by CGAL's triangulate_hole: flat holes as polygons, others with small area. The result is wound
/// consistently, without duplicate triangles. Errors: kInvalidInput (an edge of three or more triangles, where holes are
/// ambiguous), kFailure.
[[nodiscard]] Result<HoleFill> fillHoles(const TriangleMesh& mesh);

}  // namespace relief
