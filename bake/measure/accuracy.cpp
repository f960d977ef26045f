#include "bake/measure/accuracy.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <vector>

#include "formats/base/portable_math.h"
#include "formats/base/stopwatch.h"

namespace relief {
namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

double percent(std::uint64_t part, std::uint64_t whole) {
    return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

/// Calls visit(i) for all i < count, on all cores.
template <class Visit>
void forEachIndex(std::size_t count, const Visit& visit) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 512), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
            visit(i);
        }
    });
}

/// Sums in the order of the samples, not in that of the threads.
struct Spread {
    double mean = 0.0;
    double p99 = 0.0;
};
Spread spreadOf(std::vector<double> values) {
    if (values.empty()) {
        return {};
    }
    Spread spread;
    for (const double value : values) {
        spread.mean += value;
    }
    spread.mean /= static_cast<double>(values.size());
    const auto rank = static_cast<std::ptrdiff_t>((99 * values.size() + 99) / 100 - 1);
    std::nth_element(values.begin(), values.begin() + rank, values.end());
    spread.p99 = values[static_cast<std::size_t>(rank)];
    return spread;
}

std::vector<std::optional<FieldValue>> evaluateAt(const std::vector<TruthPoint>& points, const Field& field) {
    std::vector<std::optional<FieldValue>> values(points.size());
    forEachIndex(points.size(), [&](std::size_t i) { values[i] = field(points[i].position); });
    return values;
}

WrongShare wrongShare(const std::vector<TruthPoint>& points,
                      const std::vector<std::optional<FieldValue>>& values) {
    std::uint64_t false_inside = 0;
    std::uint64_t false_outside = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool inside = values[i] && values[i]->distance < 0.0F;
        false_inside += inside && !points[i].inside() ? 1 : 0;
        false_outside += !inside && points[i].inside() ? 1 : 0;
    }
    return {percent(false_inside, points.size()), percent(false_outside, points.size())};
}

void measureDistances(const std::vector<TruthPoint>& points,
                      const std::vector<std::optional<FieldValue>>& values, FieldAccuracy& accuracy) {
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
    const Spread spread = spreadOf(std::move(errors));
    accuracy.distance_mean = spread.mean;
    accuracy.distance_p99 = spread.p99;
    accuracy.far_percent = percent(far, points.size());
    accuracy.unknown_percent = percent(unknown, points.size());
}

void measureNormals(const std::vector<SurfacePoint>& points, const Field& field, FieldAccuracy& accuracy) {
    constexpr double kNone = -1.0;
    std::vector<double> angles(points.size(), kNone);
    forEachIndex(points.size(), [&](std::size_t i) {
        const std::optional<FieldValue> value = field(points[i].position);
        if (!points[i].buried && value && glm::dot(value->normal, value->normal) > 0.0F) {
            const glm::dvec3 a = glm::normalize(glm::dvec3(value->normal));
            const glm::dvec3 b = points[i].normal;
            // Exact for small angles, where acos of the cosine is not.
            angles[i] = kDegrees * portable::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        }
    });
    const auto counted = static_cast<std::uint64_t>(
        std::count_if(points.begin(), points.end(), [](const SurfacePoint& point) { return !point.buried; }));
    angles.erase(std::remove(angles.begin(), angles.end(), kNone), angles.end());
    accuracy.no_normal_percent = percent(counted - angles.size(), counted);
    const Spread spread = spreadOf(std::move(angles));
    accuracy.normal_mean = spread.mean;
    accuracy.normal_p99 = spread.p99;
}

/// The lines of sight of one map.
class Sight {
  public:
    Sight(const DepthMap& map, const MeshQuery& query) : map_(map), query_(query) {
        const Affine& t = map.object_to_map;
        for (int i = 0; i < 3; ++i) {
            rows_[i] = {t.row[i].x, t.row[i].y, t.row[i].z};
            offset_[i] = t.row[i].w;
        }
        // The transposed matrix of rows has them as its columns.
        to_object_ = glm::inverse(glm::transpose(glm::dmat3(rows_[0], rows_[1], rows_[2])));
    }

    /// \param p  a point a little off the surface, object space.
    [[nodiscard]] bool sees(const glm::dvec3& p, const glm::dvec3& normal) const {
        const glm::dvec3 in_map(glm::dot(rows_[0], p) + offset_.x, glm::dot(rows_[1], p) + offset_.y,
                                glm::dot(rows_[2], p) + offset_.z);
        return map_.projection() == Projection::kCube ? cubeSees(p, in_map, normal)
                                                      : orthographicSees(p, in_map, normal);
    }

  private:
    [[nodiscard]] bool isFree(const glm::dvec3& p, const glm::dvec3& sight, const glm::dvec3& normal) const {
        return glm::dot(sight, normal) > 0.0 && query_.segmentIsFree(p, p + sight);
    }

    [[nodiscard]] bool orthographicSees(const glm::dvec3& p, const glm::dvec3& in_map,
                                        const glm::dvec3& normal) const {
        const double x = in_map.x * map_.width;
        const double y = in_map.y * map_.height;
        if (!(x >= 1.0 && y >= 1.0 && x < map_.width - 1.0 && y < map_.height - 1.0 && in_map.z >= 0.0 &&
              in_map.z <= 1.0)) {
            return false;
        }
        const glm::dvec3& along = to_object_[2];
        return (map_.compare != Compare::kGreater && isFree(p, -in_map.z * along, normal)) ||
               (map_.compare != Compare::kLess && isFree(p, (1.0 - in_map.z) * along, normal));
    }

    [[nodiscard]] bool cubeSees(const glm::dvec3& p, const glm::dvec3& in_map,
                                const glm::dvec3& normal) const {
        const double reach = std::max({std::abs(in_map.x), std::abs(in_map.y), std::abs(in_map.z)});
        if (!(reach <= 1.0 && reach > 0.0)) {
            return false;
        }
        // To the centre, or away from it to the face of the volume.
        const double share = map_.compare == Compare::kLess ? -1.0 : 1.0 / reach - 1.0;
        return isFree(p, to_object_ * (share * in_map), normal);
    }

    const DepthMap& map_;
    const MeshQuery& query_;
    glm::dvec3 rows_[3];
    glm::dvec3 offset_{0.0};
    glm::dmat3 to_object_{1.0};
};

double unseenPercent(const TruthSamples& samples, const MeshQuery& query, const Collider& collider) {
    std::vector<Sight> sights;
    for (const DepthMap& map : collider.maps) {
        sights.emplace_back(map, query);
    }
    const double step = kSurfaceStep * samples.longest_side;
    std::vector<char> unseen(samples.surface.size(), 0);
    forEachIndex(samples.surface.size(), [&](std::size_t i) {
        const SurfacePoint& point = samples.surface[i];
        const glm::dvec3 normal = point.normal;
        const glm::dvec3 p = glm::dvec3(point.position) + step * normal;
        unseen[i] = !point.buried && std::none_of(sights.begin(), sights.end(),
                                                  [&](const Sight& s) { return s.sees(p, normal); })
                        ? 1
                        : 0;
    });
    const auto counted =
        static_cast<std::uint64_t>(std::count_if(samples.surface.begin(), samples.surface.end(),
                                                 [](const SurfacePoint& point) { return !point.buried; }));
    return percent(static_cast<std::uint64_t>(std::count(unseen.begin(), unseen.end(), 1)), counted);
}

}  // namespace

Field fieldOf(const Collider& collider) {
    return [&collider](const glm::vec3& p) -> std::optional<FieldValue> {
        const FieldSample sample = evaluate(collider, p);
        return sample.map < 0 ? std::nullopt : std::optional(FieldValue{sample.distance, sample.normal});
    };
}

WrongShare measureNear(const std::vector<TruthPoint>& points, const Field& field) {
    return wrongShare(points, evaluateAt(points, field));
}

FieldAccuracy measureField(const TruthSamples& samples, const Field& field) {
    const Stopwatch watch;
    FieldAccuracy accuracy;
    {
        const std::vector<std::optional<FieldValue>> values = evaluateAt(samples.near, field);
        accuracy.near = wrongShare(samples.near, values);
        measureDistances(samples.near, values, accuracy);
    }
    accuracy.uniform = wrongShare(samples.uniform, evaluateAt(samples.uniform, field));
    measureNormals(samples.surface, field, accuracy);
    accuracy.seconds = watch.seconds();
    return accuracy;
}

ColliderAccuracy measureCollider(const TruthSamples& samples, const MeshQuery& query,
                                 const Collider& collider) {
    ColliderAccuracy accuracy;
    accuracy.field = measureField(samples, fieldOf(collider));
    accuracy.unseen_percent = unseenPercent(samples, query, collider);
    accuracy.buried_percent = percent(
        static_cast<std::uint64_t>(std::count_if(samples.surface.begin(), samples.surface.end(),
                                                 [](const SurfacePoint& point) { return point.buried; })),
        samples.surface.size());
    accuracy.gpu_bytes = collider.texelBytes();
    return accuracy;
}

}  // namespace relief
