#include "bake/mesh_edges.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>
#include <tuple>

namespace relief {
namespace {

/// The last step of SplitMix64 (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
}

/// The same for equal positions.
std::uint64_t hashOf(const glm::vec3& p) {
    // −0 equals 0, and plus 0 is the same bits.
    const auto bits = [](float value) { return std::uint64_t{std::bit_cast<std::uint32_t>(value + 0.0F)}; };
    return mixed(mixed(bits(p.x) << 32 | bits(p.y)) + bits(p.z));
}

}  // namespace

std::vector<std::uint32_t> weldedVertices(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
        const glm::vec3& a = mesh.positions[i];
        const glm::vec3& b = mesh.positions[j];
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z != b.z ? a.z < b.z : i < j;
    });
    std::vector<std::uint32_t> welded(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]];
        welded[order[i]] = same ? welded[order[i - 1]] : order[i];
    }
    return welded;
}

MeshEdges edgesOf(const TriangleMesh& mesh) {
    MeshEdges edges{weldedVertices(mesh), {}};
    const std::vector<std::uint32_t>& welded = edges.welded;
    std::vector<EdgeUse>& uses = edges.uses;
    uses.reserve(3 * mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        for (std::uint8_t side = 0; side < 3; ++side) {
            const std::uint32_t a = welded[t[side]];
            const std::uint32_t b = welded[t[(side + 1) % 3]];
            uses.push_back({std::min(a, b), std::max(a, b), i, side, a > b});
        }
    }
    tbb::parallel_sort(uses, [](const EdgeUse& a, const EdgeUse& b) {
        return std::tie(a.low, a.high, a.triangle, a.side) < std::tie(b.low, b.high, b.triangle, b.side);
    });
    return edges;
}

bool edgesAreEven(const TriangleMesh& mesh) {
    std::vector<std::uint64_t> hashes(mesh.positions.size());
    std::transform(mesh.positions.begin(), mesh.positions.end(), hashes.begin(), hashOf);
    // Equal edges cancel out in pairs.
    const auto sum = [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t odd) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const glm::uvec3& t = mesh.triangles[i];
            odd ^= mixed(hashes[t.x] + hashes[t.y]) ^ mixed(hashes[t.y] + hashes[t.z]) ^
                   mixed(hashes[t.z] + hashes[t.x]);
        }
        return odd;
    };
    return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, mesh.triangles.size(), 4096),
                                std::uint64_t{0}, sum, std::bit_xor<>()) == 0;
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

std::vector<OddEdge> oddEdges(const TriangleMesh& mesh) {
    return oddEdges(edgesOf(mesh));
}

}  // namespace relief
