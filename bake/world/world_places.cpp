// SPDX-License-Identifier: Apache-2.0
#include "bake/world/world_places.h"

#include <algorithm>

#include "bake/maps/bake_maps.h"
#include "bake/measure/worst_places.h"
#include "bake/mesh/loops.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Side of a slice: a multiple of the point's distance from the surface, so that the distance is visible. It is clamped
/// to a range, in units of the body's longest side.
constexpr double kDistances = 40.0;
constexpr double kLeast = 0.02;
constexpr double kMost = 1.2;

void fillSlice(const WorldPlaceQuery& query, VerdictSlice& slice) {
    const glm::dvec3 half(0.5 * slice.side);
    const glm::dvec3 low = glm::dvec3(slice.center) - half;
    const glm::dvec3 high = glm::dvec3(slice.center) + half;
    const std::vector<const PlacedMesh*> meshes = placedIn(query.level, low, high);
    const std::vector<std::uint32_t> bodies = query.field.bodiesIn({glm::vec3(low), glm::vec3(high)});
    forEachIndex(0, slice.verdicts.size(), slice.size, [&](std::size_t i) {
        const glm::vec3 p(slice.point(static_cast<std::uint32_t>(i % slice.size),
                                      static_cast<std::uint32_t>(i / slice.size)));
        const bool truth = std::any_of(meshes.begin(), meshes.end(),
                                       [&p](const PlacedMesh* one) { return one->inside(glm::dvec3(p)); });
        const bool inside = query.field.evaluate(p, bodies).inside();
        slice.verdicts[i] = inside == truth ? (inside ? SideVerdict::kInside : SideVerdict::kOutside)
                            : inside        ? SideVerdict::kFalseInside
                                            : SideVerdict::kFalseOutside;
    });
}

}  // namespace

WorldPlace worldPlace(const WorldPlaceQuery& query, bool picture) {
    const PlacedMesh& own = query.level[query.body];
    const ClosestPoint closest = own.query->closest(glm::vec3(own.toObject(glm::dvec3(query.place))));
    WorldPlace place;
    place.normal =
        glm::vec3(glm::normalize(own.turn(planeOf(own.query->mesh(), closest.triangle).normal, 1.0)));
    place.distance = own.body->scale * double{closest.distance};
    const WorldSample sample = query.field.evaluate(query.place);
    if (sample.body >= 0) {
        const auto body = static_cast<std::size_t>(sample.body);
        const glm::vec3 at = query.field.toObject(body, query.place);
        const Collider& collider = query.field.colliderOf(body);
        const int map = evaluate(collider, at).map;
        place.texel = map < 0 ? 0.0
                              : double{query.field.world().bodies[body].scale} *
                                    texelAt(collider.maps[static_cast<std::size_t>(map)], at);
    }
    place.cause = query.moved                                   ? WorldCause::kMoved
                  : floatsLimit(own.query->mesh(), query.wrong) ? WorldCause::kPrecision
                  : place.distance <= kTexelsOff * place.texel  ? WorldCause::kTexel
                                                                : WorldCause::kMesh;
    if (picture) {
        const double longest = own.body->scale * double{own.query->mesh().bounds.longestSide()};
        place.slice =
            verdictSlice(query.place, place.normal,
                         std::clamp(kDistances * place.distance, kLeast * longest, kMost * longest));
        fillSlice(query, *place.slice);
    }
    return place;
}

}  // namespace relief
