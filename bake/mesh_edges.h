// Edges of a mesh, where equal positions are one vertex: importers repeat positions along seams.
#pragma once

#include <cstdint>
#include <vector>

#include "bake/mesh.h"

namespace relief {

/// An edge that belongs to an odd number of triangles: the border of a hole, or of a flap on a closed
/// surface. Vertices are named by the lowest index of their position.
struct OddEdge {
    std::uint32_t from = 0;  ///< from and to in the order of the edge's triangles, of most of them if three
    std::uint32_t to = 0;

    friend bool operator==(const OddEdge&, const OddEdge&) = default;
};

/// In ascending order of the lower and then of the higher vertex. None: any ray from a point meets the
/// surface as often, modulo 2, as any other.
[[nodiscard]] std::vector<OddEdge> oddEdges(const TriangleMesh& mesh);

/// Whether there is no odd edge, without sorting: by a sum of 64-bit hashes of the edges. Wrong for one open
/// mesh in 2⁶⁴, which then seems closed.
[[nodiscard]] bool edgesAreEven(const TriangleMesh& mesh);

}  // namespace relief
