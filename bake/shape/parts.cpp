#include "bake/shape/parts.h"

#include <cmath>

#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// In units of the area to the power of 3/2: with less, triangles enclose nothing. Of a sphere it is 0.094.
constexpr double kVolumeMin = 1e-5;

}  // namespace

std::vector<Part> partsOf(const TriangleMesh& mesh, const MeshEdges& edges) {
    DisjointSets sets(mesh.triangles.size());
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin + 1; i < end; ++i) {
            sets.join(edges.uses[begin].triangle, edges.uses[i].triangle);
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
    forEachEdge(edges.uses, [&](std::size_t begin, std::size_t end) {
        Part& part = parts[part_of[edges.uses[begin].triangle]];
        std::size_t down = 0;
        for (std::size_t i = begin; i < end; ++i) {
            down += edges.uses[i].down ? 1U : 0U;
        }
        part.closed = part.closed && (end - begin) % 2 == 0;
        part.manifold = part.manifold && end - begin == 2;
        part.balanced = part.balanced && 2 * down == end - begin;
    });
    return parts;
}

std::optional<double> enclosedVolume(const std::vector<glm::vec3>& positions,
                                     const std::vector<glm::uvec3>& triangles, const glm::dvec3& center) {
    double area = 0.0;
    double volume = 0.0;
    for (const glm::uvec3& t : triangles) {
        const TrianglePlane plane = planeOf(positions, t);
        area += 0.5 * std::sqrt(dot(plane.normal, plane.normal));
        volume += dot(plane.point - center, plane.normal) / 6.0;
    }
    return std::abs(volume) < kVolumeMin * area * std::sqrt(area) ? std::nullopt : std::optional(volume);
}

}  // namespace relief
