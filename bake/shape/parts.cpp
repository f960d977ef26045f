// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Minimum volume of a solid, in units of area^(3/2); a sphere has 0.094.
constexpr double kVolumeMin = 1e-5;

/// Calls visit(uses) for each edge, separately for each kind of triangle.
template <class Visit>
void forEachEdgeOfAKind(const MeshEdges& edges, std::span<const ShapeAs> kinds, const Visit& visit) {
    std::vector<EdgeUse> of_kind;
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        const std::span uses = std::span(edges.uses).subspan(begin, end - begin);
        if (kinds.empty()) {
            visit(uses);
            return;
        }
        for (std::size_t kind = 0; kind < kWordsOf<ShapeAs>.size(); ++kind) {
            of_kind.clear();
            std::copy_if(uses.begin(), uses.end(), std::back_inserter(of_kind), [&](const EdgeUse& use) {
                return kinds[use.triangle] == static_cast<ShapeAs>(kind);
            });
            if (!of_kind.empty()) {
                visit(std::span<const EdgeUse>(of_kind));
            }
        }
    });
}

}  // namespace

std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges, std::span<const ShapeAs> kinds) {
    DisjointSets sets(mesh.triangles.size());
    forEachEdgeOfAKind(edges, kinds, [&](std::span<const EdgeUse> uses) {
        for (const EdgeUse& use : uses.subspan(1)) {
            sets.join(uses.front().triangle, use.triangle);
        }
    });
    std::vector<std::uint32_t> part_of(mesh.triangles.size());
    std::vector<Part> parts;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const std::uint32_t root = sets.find(i);
        if (root == i) {
            part_of[i] = static_cast<std::uint32_t>(parts.size());
            parts.emplace_back();
        }
        part_of[i] = part_of[root];
        parts[part_of[i]].triangles.push_back(i);
    }
    forEachEdgeOfAKind(edges, kinds, [&](std::span<const EdgeUse> uses) {
        Part& part = parts[part_of[uses.front().triangle]];
        const auto down = static_cast<std::size_t>(std::ranges::count(uses, true, &EdgeUse::down));
        part.closed = part.closed && uses.size() % 2 == 0;
        part.manifold = part.manifold && uses.size() == 2;
        part.balanced = part.balanced && 2 * down == uses.size();
    });
    return parts;
}

std::vector<std::uint32_t> copiesInSolids(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
                                          std::span<const Part> parts) {
    std::vector<std::uint32_t> copies;
    for (const Part& part : parts) {
        if (part.manifold) {
            continue;  // edges of copies have at least four triangles
        }
        const std::vector<SortedTriangle> sorted = sortedTriangles(mesh, welded, part.triangles);
        std::vector<std::uint32_t> again;
        std::vector<std::array<std::uint32_t, 2>> edges;  // without copies
        for (std::size_t k = 0; k < sorted.size(); ++k) {
            const auto& [corners, triangle] = sorted[k];
            if (k > 0 && sorted[k - 1].corners == corners) {
                again.push_back(triangle);
            } else {
                edges.insert(edges.end(),
                             {{corners[0], corners[1]}, {corners[1], corners[2]}, {corners[0], corners[2]}});
            }
        }
        std::ranges::sort(edges);
        bool closed = true;
        for (std::size_t begin = 0, end = 0; closed && begin < edges.size(); begin = end) {
            while (end < edges.size() && edges[end] == edges[begin]) {
                ++end;
            }
            closed = (end - begin) % 2 == 0;
        }
        if (closed) {
            copies.insert(copies.end(), again.begin(), again.end());
        }
    }
    std::ranges::sort(copies);
    return copies;
}

std::optional<double> enclosedVolume(const std::vector<glm::vec3>& positions,
                                     const std::vector<glm::uvec3>& triangles, const glm::dvec3& center) {
    double area = 0.0;
    double volume = 0.0;
    for (const glm::uvec3& t : triangles) {
        const TrianglePlane plane = planeOf(positions, t);
        area += 0.5 * length(plane.normal);
        volume += dot(plane.point - center, plane.normal) / 6.0;
    }
    return std::abs(volume) < kVolumeMin * area * std::sqrt(area) ? std::nullopt : std::optional(volume);
}

}  // namespace relief
