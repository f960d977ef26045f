// SPDX-License-Identifier: Apache-2.0
// Measures the accuracy of a field against a mesh, for colliders and for other representations.
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

/// The value of a field at a point.
struct FieldValue {
    float distance = 0.0F;   ///< object units, negative inside; kFarOutside: outside at an unknown distance
    glm::vec3 normal{0.0F};  ///< unit length, outwards; zero if unknown
};

/// A field to measure, called from many threads. nullopt means unknown and is treated as outside, because particles
/// pass through.
using Field = std::function<std::optional<FieldValue>(const glm::vec3&)>;

/// Returns the field of the vote: the distance to the deciding surface, and its normal. \param collider  borrowed.
[[nodiscard]] Field fieldOf(const Collider& collider);

/// Like fieldOf(), with the distance to the nearest surface (nearest_surface.h); takes about 13 times as long.
/// \param collider  borrowed.
[[nodiscard]] Field nearestFieldOf(const Collider& collider);

/// Misclassified points, as percentages of all points measured.
struct WrongPercent {
    double false_inside = 0.0;   ///< points that are outside in truth
    double false_outside = 0.0;  ///< points that are inside in truth
    [[nodiscard]] double total() const { return false_inside + false_outside; }
};

void fields(FieldVisitor& visit, const WrongPercent& share);

/// Accuracy of the vote at TruthSamples::inside.
struct InsideAccuracy {
    std::uint64_t points = 0;
    /// Points at which the nearest face does not decide, in percent: the point is classified as outside, the normal
    /// points away from the face, or the depth exceeds 1.25 times the true depth by more than 0.1 % of the longest
    /// side.
    double far_face_percent = 0.0;
    double depth_mean = 0.0;  ///< |depth − true depth| of points classified as inside, object units
    double depth_p99 = 0.0;
    double normal_mean = 0.0;  ///< angle between the normal and the direction to the boundary, degrees
    double normal_p99 = 0.0;
};

struct FieldAccuracy {
    WrongPercent near;     ///< points near the surface
    WrongPercent uniform;  ///< points in the mesh's box
    /// |f − true signed distance| over points near the surface with a known distance, object units. The 99th percentile
    /// uses the nearest rank.
    double distance_mean = 0.0;
    double distance_p99 = 0.0;
    double far_percent = 0.0;      ///< points near the surface with the distance kFarOutside
    double unknown_percent = 0.0;  ///< points near the surface without a value
    /// Angle between the normals of field and surface, in degrees, over the surface points that are not buried and
    /// where the field has a normal.
    double normal_mean = 0.0;
    double normal_p99 = 0.0;
    double no_normal_percent = 0.0;  ///< points without a normal, of the surface points that are not buried
    InsideAccuracy inside;
    double seconds = 0.0;  ///< duration of the measurement
};

/// Measures the points of sampleNear().
[[nodiscard]] WrongPercent measureNear(const std::vector<TruthPoint>& points, const Field& field);

/// Measures a field. Apart from `seconds`, the result does not depend on the number of threads.
[[nodiscard]] FieldAccuracy measureField(const TruthSamples& samples, const Field& field);

/// Replaces distance_…, far_percent and unknown_percent with those of another field. Adds to `seconds`.
void measureDistances(const TruthSamples& samples, const Field& field, FieldAccuracy& accuracy);

struct ColliderAccuracy {
    FieldAccuracy field;
    double unseen_percent = 0.0;  ///< area that no map sees (sight.h), of the area that is not buried
    double buried_percent = 0.0;  ///< of the whole area
    std::uint64_t gpu_bytes = 0;
};

/// Measures a collider: sides and normals by the vote, distances by the search for the nearest surface.
[[nodiscard]] ColliderAccuracy measureCollider(const TruthSamples& samples, const MeshQuery& query,
                                               const Collider& collider);

}  // namespace relief
