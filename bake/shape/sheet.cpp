// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/sheet.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <glm/common.hpp>
#include <span>
#include <utility>

namespace relief {
namespace {

/// Winds neighbours consistently, and cuts joints of one-sided surfaces.
void windConsistently(Sheet& sheet, const std::vector<std::array<bool, 3>>& same) {
    std::vector<std::uint8_t> state(sheet.triangles.size(), 0);  // 1: unchanged, 2: flipped
    std::vector<std::uint32_t> queue;
    for (std::uint32_t first = 0; first < sheet.triangles.size(); ++first) {
        if (state[first] != 0) {
            continue;
        }
        state[first] = 1;
        queue.assign(1, first);
        for (std::size_t at = 0; at < queue.size(); ++at) {
            const std::uint32_t here = queue[at];
            for (std::uint8_t side = 0; side < 3; ++side) {
                const std::uint32_t next = sheet.neighbours[here][side];
                if (next == Sheet::kNoTriangle) {
                    continue;
                }
                const std::uint8_t wanted = same[here][side] != (state[here] == 2) ? 2 : 1;
                if (state[next] == 0) {
                    state[next] = wanted;
                    queue.push_back(next);
                } else if (state[next] != wanted) {  // one-sided
                    for (int i = 0; i < 3; ++i) {
                        if (sheet.neighbours[next][i] == here) {
                            sheet.neighbours[next][i] = Sheet::kNoTriangle;
                        }
                    }
                    sheet.neighbours[here][side] = Sheet::kNoTriangle;
                }
            }
        }
        // The majority of the patch keeps its winding.
        const auto turned = static_cast<std::size_t>(
            std::ranges::count(queue, 2, [&](std::uint32_t triangle) { return state[triangle]; }));
        for (const std::uint32_t triangle : queue) {
            if ((state[triangle] == 2) != (2 * turned > queue.size())) {
                std::swap(sheet.triangles[triangle].y, sheet.triangles[triangle].z);
                std::swap(sheet.neighbours[triangle].x, sheet.neighbours[triangle].z);
            }
        }
    }
}

/// Joins triangles across edges of two triangles, and cuts folds, which are detectable only after neighbours are wound
/// alike.
void joinEdges(Sheet& sheet) {
    TriangleNeighbours neighbours = neighboursOf(edgeUses(sheet.triangles, sheet.positions.size()));
    sheet.neighbours = std::move(neighbours.across);
    windConsistently(sheet, neighbours.same);
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        for (int side = 0; side < 3; ++side) {
            const std::uint32_t next = sheet.neighbours[i][side];
            if (next != Sheet::kNoTriangle &&
                dot(unitNormal(sheet.positions, sheet.triangles[i]),
                    unitNormal(sheet.positions, sheet.triangles[next])) < kFoldCosine) {
                sheet.neighbours[i][side] = Sheet::kNoTriangle;
            }
        }
    }
}

}  // namespace

glm::dvec3 unitNormal(const std::vector<glm::vec3>& positions, const glm::uvec3& t) {
    return unit(planeOf(positions, t).normal);
}

TriangleMesh meshOf(const Sheet& sheet, const std::string& name) {
    TriangleMesh mesh;
    mesh.name = name;
    mesh.positions = sheet.positions;
    mesh.triangles = sheet.triangles;
    mesh.labels = sheet.sources;
    return mesh;
}

Sheet sheetOf(const TriangleMesh& mesh, std::span<const std::uint32_t> welded,
              std::span<const std::uint32_t> triangles) {
    Sheet sheet;
    std::vector<std::uint32_t> used;
    for (const std::uint32_t i : triangles) {
        for (int corner = 0; corner < 3; ++corner) {
            used.push_back(welded[mesh.triangles[i][corner]]);
        }
    }
    std::ranges::sort(used);
    used.erase(std::unique(used.begin(), used.end()), used.end());
    const auto indexOf = [&](std::uint32_t vertex) {
        return static_cast<std::uint32_t>(std::ranges::lower_bound(used, welded[vertex]) - used.begin());
    };
    for (const std::uint32_t vertex : used) {
        sheet.positions.push_back(mesh.positions[vertex]);
    }
    std::vector<std::uint32_t> with_area;
    for (const std::uint32_t i : triangles) {
        const glm::uvec3& t = mesh.triangles[i];
        if (hasArea(planeOf(mesh.positions, {welded[t.x], welded[t.y], welded[t.z]}))) {
            with_area.push_back(i);
        }
    }
    std::vector<SortedTriangle> sorted = sortedTriangles(mesh, welded, with_area);
    sheet.duplicates = dropRepeats(sorted);
    std::ranges::sort(sorted, {}, &SortedTriangle::index);
    for (const SortedTriangle& kept : sorted) {
        const glm::uvec3& t = mesh.triangles[kept.index];
        sheet.triangles.emplace_back(indexOf(t.x), indexOf(t.y), indexOf(t.z));
        sheet.sources.push_back(kept.index);
    }
    joinEdges(sheet);
    return sheet;
}

Shadow shadowOf(const Sheet& sheet) {
    Shadow shadow;
    for (const glm::uvec3& t : sheet.triangles) {
        const glm::dvec3 n = planeOf(sheet.positions, t).normal;
        shadow.signed_area += n;
        shadow.area += glm::abs(n);
    }
    return shadow;
}

}  // namespace relief
