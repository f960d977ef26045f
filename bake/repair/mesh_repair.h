// Meshes made into solids, and cut surfaces found, by CGAL. What CGAL takes for granted is checked before it
// is called, and what it throws becomes an error.
#pragma once

#include <cstdint>

#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

struct SelfIntersections {
    std::uint64_t pairs = 0;           ///< of triangles
    std::uint32_t first_triangle = 0;  ///< the lowest that is part of a pair
};

/// Candidate pairs of triangles, whose boxes overlap, that selfIntersections looks at.
inline constexpr std::uint64_t kIntersectionCandidateMax = 200'000'000;

/// Pairs of triangles that meet elsewhere than in their common vertices (equal positions are one) and edges,
/// by exact predicates. Duplicates do not count. Single-threaded: about 1 s for 100,000 triangles.
/// Errors: kLimit (kIntersectionCandidateMax), kFailure.
[[nodiscard]] Result<SelfIntersections> selfIntersections(const TriangleMesh& mesh);

struct WrapOptions {
    /// The size of the holes and gaps that the wrap spans, in units of the mesh's longest side, in
    /// [kWrapAlphaMin, kWrapAlphaMax].
    double alpha = 0.01;
};
inline constexpr double kWrapAlphaMin = 0.001;
inline constexpr double kWrapAlphaMax = 0.5;

/// The surface that shrinks round the mesh without passing holes smaller than alpha: closed, manifold, wound
/// outwards, without intersections, with the whole mesh inside it, and its vertices a thirtieth of alpha off
/// the mesh. Portaneri, Rouxel-Labbe, Hemmer, Cohen-Steiner and Alliez, "Alpha wrapping with an offset"
/// (2022). Name, hash and unit stay; the bounds grow by the offset. Time and triangles grow with the surface
/// over alpha squared: 60,000 triangles and 15 s for a bunny at 0.01. The same bytes each time, on one
/// thread. Errors: kUsage (alpha), kLimit (out of memory), kFailure.
[[nodiscard]] Result<TriangleMesh> wrapMesh(const TriangleMesh& mesh, const WrapOptions& options);

/// The mesh wound consistently wherever two triangles share an edge, taken apart where more do: positions of
/// such edges and of vertices where surfaces only touch are repeated. Which side is out is not decided here
/// (winding.h). Duplicate triangles are left out.
/// Errors: kFailure.
[[nodiscard]] Result<TriangleMesh> orientMesh(const TriangleMesh& mesh);

/// Edges of the largest hole that fillHoles triangulates.
inline constexpr std::size_t kHoleEdgesMax = 2000;

struct HoleFill {
    TriangleMesh mesh;
    std::uint64_t filled = 0;     ///< holes
    std::uint64_t triangles = 0;  ///< that fill them, at the end of the mesh
    std::uint64_t left = 0;       ///< holes that stay: larger than kHoleEdgesMax, or CGAL found no patch
};

/// Triangles over every hole, by CGAL's triangulate_hole: flat holes as polygons, others of small area. The
/// mesh is wound consistently, without duplicate triangles. Errors: kInvalidInput (an edge of three triangles
/// or more, where no one can say what a hole is), kFailure.
[[nodiscard]] Result<HoleFill> fillHoles(const TriangleMesh& mesh);

}  // namespace relief
