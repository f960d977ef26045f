// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/closed_part.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bake/mesh/inside.h"
#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/repair/hole_caps.h"
#include "bake/shape/parts.h"

namespace relief {
namespace {

/// Minimum number of probes for closing the holes of a part.
constexpr std::size_t kPartProbesMin = 64;
/// A body cut off at its foot. The hole is flat: the mean normal of its triangles has at least this length. It faces
/// down by at least this cosine. At least this fraction of the surface does not see the hole from behind, tested at
/// this many points.
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

Result<ClosedPart> closePart(const TriangleMesh& open, bool is_body, bool z_is_up) {
    const std::size_t probes = std::clamp(open.triangles.size() / 8, kPartProbesMin, kEnclosureProbes);
    const PreparedMesh closed = RELIEF_TRY(closeHoles(open, probes));
    if (!closed.closed()) {
        return ClosedPart{};
    }
    const std::optional<double> volume =
        enclosedVolume(closed->positions, closed->triangles, closed->bounds.center());
    if (!volume) {
        return ClosedPart{};
    }
    bool balanced = true;
    for (const Part& part : partsOf(*closed, closed.edges())) {
        balanced = balanced && part.balanced;
    }
    closed.freeEdges();
    const std::vector<bool> turn(closed->triangles.size(), *volume < 0.0);
    const PreparedMesh wound = PreparedMesh(closed).woundOutwards(turn);
    return ClosedPart{wound, balanced, is_body || RELIEF_TRY(isCutOffBelow(wound, z_is_up))};
}

}  // namespace relief
