// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/mesh_edges.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <tuple>

#include "bake/mesh/loops.h"
#include "bake/mesh/mersenne.h"
#include "formats/base/hash.h"

namespace relief {
namespace {

constexpr std::ptrdiff_t kLargeBucket = 1 << 16;

/// Hashes a position; equal for equal positions.
std::uint64_t hashOf(const glm::vec3& p, std::uint64_t salt) {
    // + 0 converts −0 to 0.
    const auto bits = [](float value) { return std::uint64_t{std::bit_cast<std::uint32_t>(value + 0.0F)}; };
    return splitMix64(splitMix64((bits(p.x) << 32 | bits(p.y)) ^ salt) + bits(p.z));
}

}  // namespace

// Corners, edges and the slots below use 32-bit indices.
static_assert(6 * kTriangleMax < std::uint64_t{1} << 30);

std::vector<std::uint32_t> weldedVertices(const TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    // A hash table of vertex indices + 1, with linear probing, at most half full. It contains only lower vertices, so a
    // lookup finds the first of equal positions for any hash. The salt depends on all positions, so a hostile file
    // cannot force collisions.
    const std::uint64_t salt = xxh3_64(std::as_bytes(std::span(mesh.positions)));
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * count + 1), 0);
    const std::size_t mask = slots.size() - 1;
    std::vector<std::uint32_t> welded(count);
    std::vector<std::uint32_t> home(count);
    forEachIndex(0, count, 4096, [&](std::size_t i) {
        home[i] = static_cast<std::uint32_t>(hashOf(mesh.positions[i], salt) & mask);
    });
    constexpr std::uint32_t kAhead = 16;  // vertices to prefetch
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i + kAhead < count) {
            __builtin_prefetch(&slots[home[i + kAhead]], 1);
        }
        std::size_t slot = home[i];
        while (slots[slot] != 0 && mesh.positions[slots[slot] - 1] != mesh.positions[i]) {
            slot = (slot + 1) & mask;
        }
        if (slots[slot] == 0) {
            slots[slot] = i + 1;
        }
        welded[i] = slots[slot] - 1;
    }
    return welded;
}

namespace {

template <class VertexOf>
std::vector<EdgeUse> sortedUses(const std::vector<glm::uvec3>& triangles, std::size_t vertices,
                                const VertexOf& vertexOf) {
    // One bucket per lower vertex leaves only a few entries to sort.
    Buckets<EdgeUse> by_low(vertices, [&](const auto& visit) {
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            const glm::uvec3& t = triangles[i];
            for (std::uint8_t side = 0; side < 3; ++side) {
                const std::uint32_t a = vertexOf(t[side]);
                const std::uint32_t b = vertexOf(t[(side + 1) % 3]);
                visit(std::min(a, b), EdgeUse{std::min(a, b), std::max(a, b), i, side, a > b});
            }
        }
    });
    forEachIndex(0, vertices, 1024, [&](std::size_t v) {
        const auto begin = by_low.values().begin() + by_low.first(v);
        const auto end = by_low.values().begin() + by_low.first(v + 1);
        const auto less = [](const EdgeUse& a, const EdgeUse& b) {
            return std::tie(a.high, a.triangle, a.side) < std::tie(b.high, b.triangle, b.side);
        };
        if (end - begin > kLargeBucket) {  // the centre of a fan
            tbb::parallel_sort(begin, end, less);
        } else {
            std::sort(begin, end, less);
        }
    });
    return std::move(by_low.values());
}

}  // namespace

std::vector<EdgeUse> edgeUses(const std::vector<glm::uvec3>& triangles, std::size_t vertices) {
    return sortedUses(triangles, vertices, [](std::uint32_t vertex) { return vertex; });
}

MeshEdges edgesOf(const TriangleMesh& mesh) {
    MeshEdges edges{weldedVertices(mesh), {}};
    edges.uses = sortedUses(mesh.triangles, mesh.positions.size(),
                            [&](std::uint32_t vertex) { return edges.welded[vertex]; });
    return edges;
}

TriangleNeighbours neighboursOf(const std::vector<EdgeUse>& uses) {
    const std::size_t triangles = uses.size() / 3;
    TriangleNeighbours neighbours{std::vector(triangles, glm::uvec3(TriangleNeighbours::kNone)),
                                  std::vector(triangles, std::array<bool, 3>{})};
    forEachEdge(uses, [&](std::size_t begin, std::size_t end) {
        if (end - begin == 2) {
            const EdgeUse& a = uses[begin];
            const EdgeUse& b = uses[begin + 1];
            neighbours.across[a.triangle][a.side] = b.triangle;
            neighbours.across[b.triangle][b.side] = a.triangle;
            neighbours.same[a.triangle][a.side] = neighbours.same[b.triangle][b.side] = a.down == b.down;
        }
    });
    return neighbours;
}

std::vector<SortedTriangle> sortedTriangles(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                                            std::span<const std::uint32_t> triangles) {
    std::vector<SortedTriangle> sorted;
    sorted.reserve(triangles.size());
    for (const std::uint32_t i : triangles) {
        const glm::uvec3& t = mesh.triangles[i];
        sorted.emplace_back(glm::uvec3(welded[t.x], welded[t.y], welded[t.z]), i);
    }
    tbb::parallel_sort(sorted);
    return sorted;
}

std::size_t dropRepeats(std::vector<SortedTriangle>& sorted) {
    // clang 14 cannot compile libstdc++ 12's std::ranges::unique.
    const auto end =
        std::unique(sorted.begin(), sorted.end(),
                    [](const SortedTriangle& a, const SortedTriangle& b) { return a.corners == b.corners; });
    const auto dropped = static_cast<std::size_t>(sorted.end() - end);
    sorted.erase(end, sorted.end());
    return dropped;
}

bool hasSeveralShells(const MeshEdges& edges) {
    DisjointSets triangles(edges.uses.size() / 3);
    std::size_t groups = edges.uses.size() / 3;
    bool balanced = true;
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        std::size_t down = 0;
        for (std::size_t i = begin; i < end; ++i) {
            down += edges.uses[i].down ? 1U : 0U;
            groups -= triangles.join(edges.uses[begin].triangle, edges.uses[i].triangle) ? 1U : 0U;
        }
        balanced = balanced && 2 * down == end - begin;
    });
    return balanced && groups > 1;
}

std::vector<OddEdge> oddEdges(const MeshEdges& edges) {
    std::vector<OddEdge> odd;
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        const std::span uses = std::span(edges.uses).subspan(begin, end - begin);
        if (uses.size() % 2 == 1) {
            const auto down = static_cast<std::size_t>(std::ranges::count(uses, true, &EdgeUse::down));
            const EdgeUse& edge = uses.front();
            odd.push_back(2 * down < uses.size() ? OddEdge{edge.low, edge.high}
                                                 : OddEdge{edge.high, edge.low});
        }
    });
    return odd;
}

}  // namespace relief
