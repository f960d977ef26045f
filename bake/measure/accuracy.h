// How well a field keeps to a mesh: the same code measures colliders and their rivals.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/vec3.hpp>
#include <optional>

#include "bake/measure/truth.h"
#include "bake/mesh/mesh_query.h"
#include "formats/collider.h"
#include "formats/fields/field.h"

namespace relief {

/// What a field says of a point.
struct FieldValue {
    float distance = 0.0F;   ///< object units, negative inside; kFarOutside: outside, and no more is known
    glm::vec3 normal{0.0F};  ///< unit length, outwards; zero where it is not known
};

/// A field to be measured. Called from many threads. nullopt: it does not say; particles then fly on, so that
/// this counts as outside.
using Field = std::function<std::optional<FieldValue>(const glm::vec3&)>;

/// The votes: the side, and the normal of the deciding plane. \param collider  borrowed.
[[nodiscard]] Field fieldOf(const Collider& collider);

/// The same sides with the distance to the nearest surface (nearest_surface.h), which takes about 13 times as long.
/// \param collider  borrowed.
[[nodiscard]] Field nearestFieldOf(const Collider& collider);

/// Shares of points on the wrong side, in percent of all points of their kind.
struct WrongShare {
    double false_inside = 0.0;   ///< outside in truth
    double false_outside = 0.0;  ///< inside in truth
    [[nodiscard]] double total() const { return false_inside + false_outside; }
};

template <class Visitor, FieldsOf<WrongShare> W>
void fields(Visitor& visit, W& share) {
    visit("wrong_percent", share.total(),
          {"Share of the points that are on the wrong side", "%", kPercentRange});
    visit("false_inside_percent", share.false_inside,
          {"Share of the points that are outside but classified as inside", "%", kPercentRange});
    visit("false_outside_percent", share.false_outside,
          {"Share of the points that are inside but classified as outside", "%", kPercentRange});
}

struct FieldAccuracy {
    WrongShare near;     ///< points near the surface
    WrongShare uniform;  ///< points in the box
    /// |f − true signed distance| of the points near the surface for which the field has a distance. Object
    /// units; the 99th percentile by nearest rank.
    double distance_mean = 0.0;
    double distance_p99 = 0.0;
    double far_percent = 0.0;      ///< of the points near the surface: outside without a distance
    double unknown_percent = 0.0;  ///< of the points near the surface: the field does not say
    /// Angle between the field's normal and the surface's, at surface points that are not buried and where
    /// the field has a normal. Degrees.
    double normal_mean = 0.0;
    double normal_p99 = 0.0;
    double no_normal_percent = 0.0;  ///< of the surface points that are not buried
    double seconds = 0.0;            ///< for asking all that, on all cores
};

/// \param points  as sampleNear draws them.
[[nodiscard]] WrongShare measureNear(const std::vector<TruthPoint>& points, const Field& field);

/// The same for any number of threads, but for `seconds`.
[[nodiscard]] FieldAccuracy measureField(const TruthSamples& samples, const Field& field);

/// Puts another field's distances in the place of those of the first: the figures distance_… , far_percent and
/// unknown_percent. Adds to `seconds`.
void measureDistances(const TruthSamples& samples, const Field& field, FieldAccuracy& accuracy);

struct ColliderAccuracy {
    FieldAccuracy field;
    /// Share of the surface's area, buried surface left out, that no map sees (sight.h). Percent.
    double unseen_percent = 0.0;
    double buried_percent = 0.0;  ///< share of all surface area
    std::uint64_t gpu_bytes = 0;
};

/// Sides and normals by the votes, distances by the search for the nearest surface.
[[nodiscard]] ColliderAccuracy measureCollider(const TruthSamples& samples, const MeshQuery& query,
                                               const Collider& collider);

}  // namespace relief
