// Edges of a mesh, where equal positions are one vertex: importers repeat positions along seams.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// An edge that belongs to an odd number of triangles: the border of a hole, or of a flap on a closed
/// surface. Vertices are named by the lowest index of their position.
struct OddEdge {
    std::uint32_t from = 0;  ///< from and to in the order of the edge's triangles, of most of them if three
    std::uint32_t to = 0;

    friend bool operator==(const OddEdge&, const OddEdge&) = default;
};

/// For each vertex, the lowest index of an equal position.
[[nodiscard]] std::vector<std::uint32_t> weldedVertices(const TriangleMesh& mesh);

/// One side of a triangle, between vertices as welded.
struct EdgeUse {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;  ///< from corner `side` to the next one
    bool down = false;      ///< from high to low
};

/// All sides of triangles that name each position once: by edge, then triangle, then side.
/// \param vertices  how many there are.
[[nodiscard]] std::vector<EdgeUse> edgeUses(const std::vector<glm::uvec3>& triangles, std::size_t vertices);

/// Welding and sorting take longer than most questions that are asked of them: once for several.
struct MeshEdges {
    std::vector<std::uint32_t> welded;  ///< weldedVertices
    std::vector<EdgeUse> uses;          ///< all sides of all triangles: by edge, then triangle, then side
};
[[nodiscard]] MeshEdges edgesOf(const TriangleMesh& mesh);

/// Sets of numbers that are joined one by one.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t count) : parent_(count) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    [[nodiscard]] std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    /// The lower root stays: the result does not depend on the order. \return whether they were apart.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// Calls visit(begin, end) for each edge, with the range of its uses.
template <class Visit>
void forEachEdge(const std::vector<EdgeUse>& uses, const Visit& visit) {
    for (std::size_t begin = 0; begin < uses.size();) {
        std::size_t end = begin + 1;
        while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) {
            ++end;
        }
        visit(begin, end);
        begin = end;
    }
}

/// In ascending order of the lower and then of the higher vertex. None: any ray from a point meets the
/// surface as often, modulo 2, as any other.
[[nodiscard]] std::vector<OddEdge> oddEdges(const MeshEdges& edges);

/// Several closed surfaces, each wound consistently: every edge runs as often one way as the other, and the
/// triangles fall into groups that share no edge. Such surfaces may overlap; how often they wind round a
/// point, not the parity of a ray's crossings, says then whether it lies in one of them.
[[nodiscard]] bool isSeveralShells(const MeshEdges& edges);

}  // namespace relief
