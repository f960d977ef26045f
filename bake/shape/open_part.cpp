// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/open_part.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "bake/mesh/mesh.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/repair/hole_caps.h"
#include "bake/shape/parts.h"

namespace relief {
namespace {

/// Sight samples of all open parts together, and the minimum for each part.
constexpr std::size_t kSightPoints = 4096;
constexpr std::size_t kSightPointsMin = 8;
/// A part is a sheet if more than this fraction of the rays from its darker side escape.
constexpr double kSheetSight = 0.1;
/// A part is visible if more than this fraction of the rays from its lighter side escape.
constexpr double kSeen = 0.02;
/// A sheet may be a solid with larger holes if it has at least the fraction kBodyExtent of the mesh's extent, and at most
/// the fraction kMouthMax of its projected area has no opposite side.
constexpr double kBodyExtent = 0.25;
constexpr double kMouthMax = 0.5;
/// Minimum fraction of its rectangle that a terrain covers, minimum number of triangles, and minimum fraction of the
/// mesh's extent.
constexpr double kTerrainCover = 0.98;
constexpr std::size_t kTerrainTriangles = 200;
constexpr double kTerrainExtent = 0.8;

/// Returns, for each side of a sheet, the fraction of rays that escape from the mesh; a lower bound if both exceed
/// kSheetSight.
std::array<double, 2> sightOf(const Sheet& sheet, std::size_t samples, const MeshQuery& query) {
    const double side = query.mesh().bounds.longestSide();
    const TriangleMesh mesh = meshOf(sheet, "");
    const AreaTable areas(mesh);
    MersenneRandom random(1);
    std::array<double, 2> out{};
    const auto rays = static_cast<double>(samples * kParityDirections.size());
    const auto isSheet = [&] { return std::min(out[0], out[1]) > kSheetSight * rays; };
    for (std::size_t k = 0; k < samples && !isSheet(); ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / static_cast<double>(samples);
        const auto [on, normal] = drawOnSurface(mesh, areas, at, random);
        for (std::size_t i = 0; i < kParityDirections.size() && !isSheet(); ++i) {
            const glm::dvec3& direction = kParityDirections[i];
            for (std::size_t face = 0; face < 2; ++face) {
                const glm::dvec3 towards = face == 0 ? normal : -normal;
                const glm::dvec3 from = on + kSurfaceStep * side * towards;
                const glm::dvec3 ray = dot(direction, towards) < 0.0 ? -direction : direction;
                out[face] += query.isSegmentFree(from, from + 4.0 * side * ray) ? 1.0 : 0.0;
            }
        }
    }
    return {out[0] / rays, out[1] / rays};
}

/// Returns the mesh without the triangles named as shells: rays pass through shells, which have free space on both sides.
PreparedMesh opaque(const PreparedMesh& prepared, std::span<const ShapeAs> kinds) {
    const TriangleMesh& whole = *prepared;
    TriangleMesh mesh;
    for (std::size_t i = 0; i < kinds.size(); ++i) {
        if (kinds[i] != ShapeAs::kShell) {
            mesh.triangles.push_back(whole.triangles[i]);
        }
    }
    if (mesh.triangles.size() == kinds.size()) {
        return prepared;
    }
    mesh.name = whole.name;
    mesh.positions = whole.positions;
    Result<TriangleMesh> finished = finishMesh(std::move(mesh));
    return finished ? PreparedMesh(std::move(*finished)) : prepared;  // may be too small for a mesh
}

/// Returns the up axis of a sheet that is the ground of its mesh.
/// \param parts  number of parts of the mesh.
std::optional<int> terrainAxis(const Sheet& sheet, const TriangleMesh& mesh, std::size_t parts) {
    if (sheet.triangles.size() < kTerrainTriangles) {
        return std::nullopt;
    }
    const glm::dvec3 size = boundsOf(sheet.positions).size();
    const glm::dvec3 whole = mesh.bounds.size();
    const Shadow shadow = shadowOf(sheet);
    // If the mesh has a unit, the importer has rotated it to +Y up. Otherwise +z may also be up.
    for (const int axis : {1, 2}) {
        const int across = (axis + 1) % 3;
        const int along = (axis + 2) % 3;
        const double rectangle = size[across] * size[along];
        const bool ground = size[axis] < 0.7 * std::min(size[across], size[along]) &&
                            size[across] >= kTerrainExtent * whole[across] &&
                            size[along] >= kTerrainExtent * whole[along];
        // All triangles face the same way, so nothing is covered twice.
        const bool heights = std::abs(shadow.signed_area[axis]) >= 0.9999 * shadow.area[axis] &&
                             0.5 * shadow.area[axis] >= kTerrainCover * rectangle;
        if (ground && heights && (axis == 1 || (mesh.unit.empty() && parts == 1))) {
            return axis;
        }
    }
    return std::nullopt;
}

int flattestAxis(const Sheet& sheet) {
    const glm::dvec3 area = glm::abs(shadowOf(sheet).signed_area);
    return area.y >= std::max(area.x, area.z) ? 1 : area.z >= area.x ? 2 : 0;
}

/// Minimum number of probes for closing the holes of a part.
constexpr std::size_t kPartProbesMin = 64;
/// Criteria of a body cut off at its foot. The hole is flat: the mean normal of its triangles is at least kFootFlat long.
/// It faces down with a cosine of at least kFootDown. More than the fraction kFootHidden of the surface does not see the
/// hole from behind, tested with kFootPoints points of the hole.
constexpr double kFootFlat = 0.9;
constexpr double kFootDown = 0.5;
constexpr double kFootHidden = 0.05;
constexpr int kFootPoints = 16;

/// Whether a part with holes, after closing, is a body cut off at its foot, such as a statue open below, and not a
/// vessel. A vessel's mouth faces up, or all of its inside sees the mouth.
Result<bool> isCutOffBelow(const PreparedMesh& closed, bool z_is_up) {
    glm::dvec3 mouth(0.0);
    double area = 0.0;
    const auto caps = static_cast<std::uint32_t>(closed->surfaceTriangles());
    for (std::uint32_t i = caps; i < closed->triangles.size(); ++i) {
        const glm::dvec3 normal = planeOf(*closed, i).normal;
        mouth += normal;
        area += length(normal);
    }
    const double down = std::max(-mouth.y, z_is_up ? -mouth.z : -mouth.y);
    if (closed->closed_holes != 1 || length(mouth) < kFootFlat * area || down < kFootDown * length(mouth)) {
        return false;
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(closed));
    const double step = kSurfaceStep * double{closed->bounds.longestSide()};
    MersenneRandom random(1);
    std::size_t hidden = 0;
    for (std::size_t k = 0; k < kEnclosureProbes; ++k) {
        const double at = (static_cast<double>(k) + random.uniform()) / kEnclosureProbes;
        const auto [on, normal] = drawOnSurface(*closed, closed.areas(), at, random);
        bool seen = false;
        for (int i = 0; i < kFootPoints && !seen; ++i) {
            const auto cap = static_cast<std::uint32_t>(random.below(closed->cap_triangles));
            const glm::dvec3 from = on - step * normal;
            const glm::dvec3 to = drawOnTriangle(*closed, caps + cap, random).position;
            const std::optional<FirstHit> hit = query.firstHit(from, to - from);
            seen = hit && hit->triangle >= caps;
        }
        hidden += seen ? 0 : 1;
    }
    return static_cast<double>(hidden) > kFootHidden * kEnclosureProbes;
}

}  // namespace

double sizeOf(const Sheet& sheet) {
    return double{boundsOf(sheet.positions).longestSide()};
}

Result<void> classifyOpenParts(std::span<OpenPart> open, const PreparedMesh& mesh,
                               std::span<const ShapeAs> kinds, std::size_t parts) {
    std::vector<OpenPart*> unclear;
    for (OpenPart& part : open) {
        if (part.as == ShapeAs::kTerrain) {
            part.role = {OpenKind::kTerrain,
                         terrainAxis(part.sheet, *mesh, parts).value_or(flattestAxis(part.sheet))};
        } else if (part.as == ShapeAs::kSolid) {
            part.role.kind = OpenKind::kHoled;
        } else if (part.as == ShapeAs::kAuto) {
            unclear.push_back(&part);
        }
    }
    if (unclear.empty()) {
        return {};
    }
    const MeshQuery query = RELIEF_TRY(MeshQuery::build(opaque(mesh, kinds)));
    const auto least = static_cast<std::size_t>(
        std::ceil(affordableRays(query.mesh()) * static_cast<double>(kSightPointsMin)));
    const std::size_t samples = std::max(least, kSightPoints / unclear.size());
    tbb::parallel_for(std::size_t{0}, unclear.size(), [&](std::size_t i) {
        OpenPart& part = *unclear[i];
        const std::array<double, 2> sight = sightOf(part.sheet, samples, query);
        const auto [dark, light] = std::minmax(sight[0], sight[1]);
        if (dark <= kSheetSight && light > kSeen) {
            part.role.kind = OpenKind::kHoled;
        } else if (const std::optional<int> axis = terrainAxis(part.sheet, *mesh, parts)) {
            part.role = {OpenKind::kTerrain, *axis};
        } else if (const Shadow shadow = shadowOf(part.sheet);
                   sizeOf(part.sheet) >= kBodyExtent * mesh->bounds.longestSide() &&
                   length(shadow.signed_area) <= kMouthMax * length(shadow.area)) {
            part.role.kind = OpenKind::kPossiblyHoled;
        }
    });
    return {};
}

Result<ClosedPart> closePart(const TriangleMesh& open, bool is_body, bool z_is_up) {
    const std::size_t probes = std::clamp(open.triangles.size() / 8, kPartProbesMin, kEnclosureProbes);
    const PreparedMesh closed = RELIEF_TRY(closeHoles(open, probes));
    const std::optional<double> volume =
        closed.closed() ? enclosedVolume(closed->positions, closed->triangles, closed->bounds.center())
                        : std::nullopt;
    if (!volume) {
        return ClosedPart{};
    }
    const bool balanced = std::ranges::all_of(partsOf(*closed, closed.edges()), &Part::balanced);
    closed.freeEdges();
    const std::vector<bool> turn(closed->triangles.size(), *volume < 0.0);
    const PreparedMesh wound = PreparedMesh(closed).woundOutwards(turn);
    return ClosedPart{wound, balanced, is_body || RELIEF_TRY(isCutOffBelow(wound, z_is_up))};
}

}  // namespace relief
