// SPDX-License-Identifier: Apache-2.0
// The accuracy of a field against a mesh, for colliders and their rivals alike.
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

/// A field at a point.
struct FieldValue {
    float distance = 0.0F;   ///< object units, negative inside; kFarOutside: outside at an unknown distance
    glm::vec3 normal{0.0F};  ///< unit length, outwards; zero if unknown
};

/// A field to be measured. Called from many threads. nullopt: unknown, which counts as outside, as particles fly on.
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

void fields(FieldVisitor& visit, const WrongShare& share);

/// Accuracy of the votes at TruthSamples::inside.
struct InsideAccuracy {
    std::uint64_t points = 0;
    /// Points at which the nearest face does not decide: they are called outside, the normal points away from it, or the depth is
    /// more than 1.25 times the true one and 0.1 % of the longest side. Percent.
    double far_face_percent = 0.0;
    double depth_mean = 0.0;  ///< |depth − true depth| of those that are called inside, object units
    double depth_p99 = 0.0;
    double normal_mean = 0.0;  ///< angle between the normal and the way to the boundary, degrees
    double normal_p99 = 0.0;
};

struct FieldAccuracy {
    WrongShare near;     ///< points near the surface
    WrongShare uniform;  ///< points in the box
    /// |f − true signed distance| of the points near the surface with a distance. Object units; the 99th percentile by
    /// nearest rank.
    double distance_mean = 0.0;
    double distance_p99 = 0.0;
    double far_percent = 0.0;      ///< of the points near the surface: outside without a distance
    double unknown_percent = 0.0;  ///< of the points near the surface: without a value
    /// Angle between the normals of field and surface, at surface points that are not buried and have both. Degrees.
    double normal_mean = 0.0;
    double normal_p99 = 0.0;
    double no_normal_percent = 0.0;  ///< of the surface points that are not buried
    InsideAccuracy inside;
    double seconds = 0.0;  ///< of the measurement, on all cores
};

/// \param points  as sampleNear draws them.
[[nodiscard]] WrongShare measureNear(const std::vector<TruthPoint>& points, const Field& field);

/// The same for any number of threads, but for `seconds`.
[[nodiscard]] FieldAccuracy measureField(const TruthSamples& samples, const Field& field);

/// Replaces distance_…, far_percent and unknown_percent by those of another field. Adds to `seconds`.
void measureDistances(const TruthSamples& samples, const Field& field, FieldAccuracy& accuracy);

struct ColliderAccuracy {
    FieldAccuracy field;
    double unseen_percent = 0.0;  ///< of the area that is not buried: no map sees it (sight.h)
    double buried_percent = 0.0;  ///< of the whole area
    std::uint64_t gpu_bytes = 0;
};

/// Sides and normals by the votes, distances by the search for the nearest surface.
[[nodiscard]] ColliderAccuracy measureCollider(const TruthSamples& samples, const MeshQuery& query,
                                               const Collider& collider);

}  // namespace relief
