#include "bake/mesh/mesh_edges.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <tuple>

#include "formats/base/hash.h"

namespace relief {
namespace {

constexpr std::ptrdiff_t kLargeBucket = 1 << 16;

/// The last step of SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/// The same for equal positions.
std::uint64_t hashOf(const glm::vec3& p, std::uint64_t salt) {
    // −0 equals 0, and plus 0 is the same bits.
    const auto bits = [](float value) { return std::uint64_t{std::bit_cast<std::uint32_t>(value + 0.0F)}; };
    return mixed(mixed((bits(p.x) << 32 | bits(p.y)) ^ salt) + bits(p.z));
}

}  // namespace

// Corners and their edges are counted by 32-bit numbers, and so are twice as many slots, rounded up.
static_assert(6 * kTriangleMax < std::uint64_t{1} << 30);

std::vector<std::uint32_t> weldedVertices(const TriangleMesh& mesh) {
    const std::size_t count = mesh.positions.size();
    // Linear probing at most half full, of indices + 1. A vertex meets the lower ones alone, so that the
    // first of equal ones is found whatever the hashes are. Those depend on all positions: no file is easily
    // made to have them collide.
    const std::uint64_t salt = xxh3_64(std::as_bytes(std::span(mesh.positions)));
    std::vector<std::uint32_t> slots(std::bit_ceil(2 * count + 1), 0);
    const std::size_t mask = slots.size() - 1;
    std::vector<std::uint32_t> welded(count);
    std::vector<std::uint32_t> wanted(count);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            wanted[i] = static_cast<std::uint32_t>(hashOf(mesh.positions[i], salt) & mask);
        }
    });
    constexpr std::uint32_t kAhead = 16;  // vertices that the walk through the slots is announced to memory
    for (std::uint32_t i = 0; i < count; ++i) {
        if (i + kAhead < count) {
            __builtin_prefetch(&slots[wanted[i + kAhead]], 1);
        }
        std::size_t slot = wanted[i];
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

/// \param vertexOf  what the corners of triangles stand for.
template <class VertexOf>
std::vector<EdgeUse> sortedUses(const std::vector<glm::uvec3>& triangles, std::size_t vertices,
                                const VertexOf& vertexOf) {
    std::vector<EdgeUse> uses(3 * triangles.size());
    const auto forEachSide = [&](auto&& visit) {
        for (std::uint32_t i = 0; i < triangles.size(); ++i) {
            const glm::uvec3& t = triangles[i];
            for (std::uint8_t side = 0; side < 3; ++side) {
                const std::uint32_t a = vertexOf(t[side]);
                const std::uint32_t b = vertexOf(t[(side + 1) % 3]);
                visit(EdgeUse{std::min(a, b), std::max(a, b), i, side, a > b});
            }
        }
    };
    // Into a bucket for each lower vertex, where few are left to sort.
    std::vector<std::uint32_t> first(vertices + 1, 0);
    forEachSide([&](const EdgeUse& use) { ++first[use.low + 1]; });
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
    forEachSide([&](const EdgeUse& use) { uses[next[use.low]++] = use; });
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, next.size(), 1024), [&](const auto& range) {
        for (std::size_t v = range.begin(); v != range.end(); ++v) {
            const auto begin = uses.begin() + first[v];
            const auto end = uses.begin() + first[v + 1];
            const auto less = [](const EdgeUse& a, const EdgeUse& b) {
                return std::tie(a.high, a.triangle, a.side) < std::tie(b.high, b.triangle, b.side);
            };
            if (end - begin > kLargeBucket) {  // the hub of a fan
                tbb::parallel_sort(begin, end, less);
            } else {
                std::sort(begin, end, less);
            }
        }
    });
    return uses;
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

bool isSeveralShells(const MeshEdges& edges) {
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
        const auto first = edges.uses.begin() + static_cast<std::ptrdiff_t>(begin);
        const std::size_t count = end - begin;
        const auto down = static_cast<std::size_t>(std::count_if(
            first, first + static_cast<std::ptrdiff_t>(count), [](const EdgeUse& use) { return use.down; }));
        if (count % 2 == 1) {
            odd.push_back(2 * down < count ? OddEdge{first->low, first->high}
                                           : OddEdge{first->high, first->low});
        }
    });
    return odd;
}

}  // namespace relief
