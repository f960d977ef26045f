// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/walls.h"

#include <algorithm>
#include <cstddef>
#include <glm/geometric.hpp>
#include <numeric>
#include <optional>
#include <utility>

namespace relief {
namespace {

/// Minimum extent of the smaller shell, as a fraction of the larger one's.
constexpr double kShellExtent = 0.25;

/// Returns whether a sheet is wound against the file; nullopt if only some of its triangles are.
std::optional<bool> turnedSinceImport(const Sheet& sheet, const TriangleMesh& mesh,
                                      const std::vector<bool>& turned) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3& t = sheet.triangles[i];
        const glm::dvec3 a = sheet.positions[t.x];
        const glm::dvec3 normal =
            cross(glm::dvec3(sheet.positions[t.y]) - a, glm::dvec3(sheet.positions[t.z]) - a);
        const bool against = dot(normal, planeOf(mesh, sheet.sources[i]).normal) < 0.0;
        count += against != turned[sheet.sources[i]] ? 1 : 0;
    }
    return count == 0 || count == sheet.triangles.size() ? std::optional(count > 0) : std::nullopt;
}

/// Per candidate, whether some other candidate may be the second shell of its wall.
std::vector<bool> mayBeWalls(const std::vector<WallCandidate>& candidates) {
    std::vector<Bounds> bounds;
    for (const WallCandidate& candidate : candidates) {
        bounds.push_back(boundsOf(candidate.sheet->positions));
    }
    const auto mayFace = [&](std::size_t a, std::size_t b) {
        const auto [least, most] = std::minmax(bounds[a].longestSide(), bounds[b].longestSide());
        return least >= static_cast<float>(kShellExtent) * most &&
               (bounds[a].contains(bounds[b].center()) || bounds[b].contains(bounds[a].center()));
    };
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(bounds[i].min.x, i); });
    std::vector<bool> may_be_wall(candidates.size(), false);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const std::size_t a = order[i];
        for (std::size_t k = i + 1; k < order.size() && bounds[order[k]].min.x <= bounds[a].max.x; ++k) {
            const std::size_t b = order[k];
            if ((candidates[a].may_be_solid || candidates[b].may_be_solid) && mayFace(a, b)) {
                may_be_wall[a] = may_be_wall[b] = true;
            }
        }
    }
    return may_be_wall;
}

}  // namespace

ShellWalls wallsAmong(const std::vector<WallCandidate>& candidates, const std::string& name) {
    const std::vector<bool> may_be_wall = mayBeWalls(candidates);
    std::vector<std::size_t> indices;
    std::vector<OpenShell> shells;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (!candidates[i].may_join || !may_be_wall[i]) {
            continue;
        }
        Result<TriangleMesh> mesh = finishMesh(meshOf(*candidates[i].sheet, name));
        if (mesh) {  // else too small for a mesh
            indices.push_back(i);
            shells.push_back({std::move(*mesh), candidates[i].may_be_solid});
        }
    }
    ShellWalls walls = joinRims(shells);
    for (auto& [outer, inner] : walls.unjoined) {
        outer = indices[outer];
        inner = indices[inner];
    }
    for (ShellWall& wall : walls.walls) {
        wall.outer = indices[wall.outer];
        wall.inner = indices[wall.inner];
    }
    return walls;
}

bool isAmbiguous(const ShellWall& wall, const std::vector<WallCandidate>& candidates,
                 const TriangleMesh& mesh, const std::vector<bool>& turned) {
    const std::optional<bool> outer = turnedSinceImport(*candidates[wall.outer].sheet, mesh, turned);
    const std::optional<bool> inner = turnedSinceImport(*candidates[wall.inner].sheet, mesh, turned);
    return !outer || !inner || wall.alike != (outer != inner);
}

}  // namespace relief
