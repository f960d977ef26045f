// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/accuracy.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "bake/measure/percent.h"
#include "bake/measure/sight.h"
#include "bake/mesh/loops.h"
#include "formats/base/portable_math.h"
#include "formats/base/stopwatch.h"
#include "formats/nearest_surface.h"

namespace relief {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;
/// Limits for InsideAccuracy::far_face_percent, relative to the true depth and to the longest side. Within 0.45 of a
/// wall's thickness, the opposite face is at least 1.22 times as far.
constexpr double kFarFace = 1.25;
constexpr double kFarFaceShare = 1e-3;

using FieldValues = std::vector<std::optional<FieldValue>>;

/// Returns the mean and the 99th percentile. Sums in sample order, so that the result does not depend on the number of
/// threads.
std::pair<double, double> spreadOf(std::vector<double> values) {
    if (values.empty()) {
        return {};
    }
    const double mean =
        std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>((99 * values.size() + 99) / 100 - 1);
    std::nth_element(values.begin(), nth, values.end());
    return {mean, *nth};
}

template <class Point>
FieldValues evaluateAt(const std::vector<Point>& points, const Field& field) {
    FieldValues values(points.size());
    forEachIndex(0, points.size(), 512, [&](std::size_t i) { values[i] = field(points[i].position); });
    return values;
}

WrongPercent wrongPercent(const std::vector<TruthPoint>& points, const FieldValues& values) {
    std::uint64_t false_inside = 0;
    std::uint64_t false_outside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool inside = values[i] && values[i]->distance < 0.0F;
        false_inside += inside && !points[i].inside() ? 1 : 0;
        false_outside += !inside && points[i].inside() ? 1 : 0;
    }
    return {percent(false_inside, points.size()), percent(false_outside, points.size())};
}

void compareDistances(const std::vector<TruthPoint>& points, const FieldValues& values,
                      FieldAccuracy& accuracy) {
    std::vector<double> errors;
    errors.reserve(points.size());
    std::uint64_t far = 0;
    std::uint64_t unknown = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!values[i]) {
            ++unknown;
        } else if (values[i]->distance >= kFarOutside) {
            ++far;
        } else {
            errors.push_back(std::abs(double{values[i]->distance} - double{points[i].distance}));
        }
    }
    std::tie(accuracy.distance_mean, accuracy.distance_p99) = spreadOf(std::move(errors));
    accuracy.far_percent = percent(far, points.size());
    accuracy.unknown_percent = percent(unknown, points.size());
}

/// In degrees. Accurate for small angles, unlike acos of the cosine.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return kDegrees * portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

void measureNormals(const std::vector<SurfacePoint>& points, const Field& field, FieldAccuracy& accuracy) {
    constexpr double kNone = -1.0;
    std::vector<double> angles(points.size(), kNone);
    forEachIndex(0, points.size(), 512, [&](std::size_t i) {
        const std::optional<FieldValue> value = field(points[i].position);
        if (!points[i].buried && value && glm::dot(value->normal, value->normal) > 0.0F) {
            angles[i] = angleBetween(glm::normalize(glm::dvec3(value->normal)), points[i].normal);
        }
    });
    const std::size_t counted = points.size() - buriedPoints(points);
    std::erase(angles, kNone);
    accuracy.no_normal_percent = percent(counted - angles.size(), counted);
    std::tie(accuracy.normal_mean, accuracy.normal_p99) = spreadOf(std::move(angles));
}

InsideAccuracy measureInside(const TruthSamples& samples, const Field& field) {
    const std::vector<InsidePoint>& points = samples.inside;
    const FieldValues values = evaluateAt(points, field);
    std::vector<double> depths;
    std::vector<double> angles;
    std::uint64_t far_face = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!values[i] || !(values[i]->distance < 0.0F)) {
            ++far_face;
            continue;
        }
        const double depth = -double{values[i]->distance};
        const glm::dvec3 normal = values[i]->normal;
        depths.push_back(std::abs(depth - points[i].depth));
        const bool deep = depth > kFarFace * points[i].depth + kFarFaceShare * samples.longest_side;
        far_face += deep || glm::dot(normal, points[i].out) < 0.0 ? 1 : 0;
        if (glm::dot(normal, normal) > 0.0) {
            angles.push_back(angleBetween(glm::normalize(normal), points[i].out));
        }
    }
    InsideAccuracy accuracy;
    accuracy.points = points.size();
    accuracy.far_face_percent = percent(far_face, points.size());
    std::tie(accuracy.depth_mean, accuracy.depth_p99) = spreadOf(std::move(depths));
    std::tie(accuracy.normal_mean, accuracy.normal_p99) = spreadOf(std::move(angles));
    return accuracy;
}

}  // namespace

Field fieldOf(const Collider& collider) {
    return [&collider](const glm::vec3& p) -> std::optional<FieldValue> {
        const FieldSample sample = evaluate(collider, p);
        return sample.map < 0 ? std::nullopt : std::optional(FieldValue{sample.distance, sample.normal});
    };
}

Field nearestFieldOf(const Collider& collider) {
    return [&collider](const glm::vec3& p) -> std::optional<FieldValue> {
        const SurfaceSample nearest = nearestSurface(collider, p);
        return nearest.map < 0 ? std::nullopt : std::optional(FieldValue{nearest.distance, nearest.normal});
    };
}

WrongPercent measureNear(const std::vector<TruthPoint>& points, const Field& field) {
    return wrongPercent(points, evaluateAt(points, field));
}

FieldAccuracy measureField(const TruthSamples& samples, const Field& field) {
    const Stopwatch watch;
    FieldAccuracy accuracy;
    {
        const FieldValues values = evaluateAt(samples.near, field);
        accuracy.near = wrongPercent(samples.near, values);
        compareDistances(samples.near, values, accuracy);
    }
    accuracy.uniform = wrongPercent(samples.uniform, evaluateAt(samples.uniform, field));
    measureNormals(samples.surface, field, accuracy);
    accuracy.inside = measureInside(samples, field);
    accuracy.seconds = watch.seconds();
    return accuracy;
}

void measureDistances(const TruthSamples& samples, const Field& field, FieldAccuracy& accuracy) {
    const Stopwatch watch;
    compareDistances(samples.near, evaluateAt(samples.near, field), accuracy);
    accuracy.seconds += watch.seconds();
}

ColliderAccuracy measureCollider(const TruthSamples& samples, const MeshQuery& query,
                                 const Collider& collider) {
    ColliderAccuracy accuracy;
    accuracy.field = measureField(samples, fieldOf(collider));
    measureDistances(samples, nearestFieldOf(collider), accuracy.field);
    accuracy.unseen_percent = Sights(collider.maps, query).unseenPercent(samples.surface);
    accuracy.buried_percent = percent(buriedPoints(samples.surface), samples.surface.size());
    accuracy.gpu_bytes = collider.texelBytes();
    return accuracy;
}

void fields(FieldVisitor& visit, const WrongPercent& share) {
    visit("wrong_percent", share.total(),
          {"Fraction of the points that are on the wrong side", "%", kPercentRange});
    visit("false_inside_percent", share.false_inside,
          {"Fraction of the points that are outside but classified as inside", "%", kPercentRange});
    visit("false_outside_percent", share.false_outside,
          {"Fraction of the points that are inside but classified as outside", "%", kPercentRange});
}

}  // namespace relief
