// SPDX-License-Identifier: Apache-2.0
// Finds the edges of a mesh. Equal positions count as one vertex, because importers repeat positions along seams.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "bake/mesh/mesh.h"

namespace relief {

/// An edge with an odd number of triangles: the border of a hole, or of a flap on a closed surface. Vertices are the
/// lowest indices of their positions.
struct OddEdge {
    std::uint32_t from = 0;  ///< `from` to `to` is the direction in most of its triangles
    std::uint32_t to = 0;

    friend bool operator==(const OddEdge&, const OddEdge&) = default;
};

/// Returns, per vertex, the lowest index with an equal position.
[[nodiscard]] std::vector<std::uint32_t> weldedVertices(const TriangleMesh& mesh);

/// A side of a triangle, between welded vertices.
struct EdgeUse {
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint32_t triangle = 0;
    std::uint8_t side = 0;  ///< from corner `side` to the next corner
    bool down = false;      ///< directed from high to low
};

/// Returns all sides of triangles, sorted by edge, then triangle, then side.
/// \param triangles  of welded vertices. \param vertices  number of positions.
[[nodiscard]] std::vector<EdgeUse> edgeUses(const std::vector<glm::uvec3>& triangles, std::size_t vertices);

struct MeshEdges {
    std::vector<std::uint32_t> welded;  ///< weldedVertices()
    std::vector<EdgeUse> uses;          ///< edgeUses() of the welded vertices
};
[[nodiscard]] MeshEdges edgesOf(const TriangleMesh& mesh);

/// Union-find.
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
    /// Joins two sets. The lower root remains, so the result does not depend on the order of calls. \return whether
    /// they were separate.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
        return a != b;
    }

  private:
    std::vector<std::uint32_t> parent_;
};

/// Calls visit(begin, end) with the range of uses of each edge.
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

/// Returns the odd edges, sorted by lower, then higher vertex. If there are none, all rays from a point have the same
/// crossing parity.
[[nodiscard]] std::vector<OddEdge> oddEdges(const MeshEdges& edges);

/// The neighbour across each side, for edges with exactly two triangles.
struct TriangleNeighbours {
    static constexpr std::uint32_t kNone = 0xffffffff;
    std::vector<glm::uvec3>
        across;  ///< per triangle: [i] is across the side from corner i to the next; kNone for other edges
    std::vector<std::array<bool, 3>> same;  ///< both triangles traverse the edge in the same direction
};
[[nodiscard]] TriangleNeighbours neighboursOf(const std::vector<EdgeUse>& uses);

/// A triangle with its welded corners in ascending order: equal for coincident triangles, regardless of winding.
struct SortedTriangle {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t index;

    SortedTriangle() = default;
    SortedTriangle(const glm::uvec3& t, std::uint32_t triangle) : corners{t.x, t.y, t.z}, index(triangle) {
        std::ranges::sort(corners);
    }
    friend auto operator<=>(const SortedTriangle&, const SortedTriangle&) = default;
};
/// Returns the given triangles, sorted by corners, then index.
[[nodiscard]] std::vector<SortedTriangle> sortedTriangles(const TriangleMesh& mesh,
                                                          std::span<const std::uint32_t> welded,
                                                          std::span<const std::uint32_t> triangles);
/// Keeps the first entry of each set with equal corners. \return the number removed.
std::size_t dropRepeats(std::vector<SortedTriangle>& sorted);

/// Whether the mesh consists of several closed surfaces, each wound consistently: every edge is used equally often in
/// both directions, and the triangles form groups that share no edge. Such surfaces may overlap; then the winding
/// number decides whether a point is inside, not the parity of ray crossings.
[[nodiscard]] bool hasSeveralShells(const MeshEdges& edges);

}  // namespace relief
