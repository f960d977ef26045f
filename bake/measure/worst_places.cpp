// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/worst_places.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "bake/measure/patch_cells.h"
#include "bake/measure/percent.h"
#include "bake/mesh/loops.h"

namespace relief {
namespace {

/// Side of a cell, in units of the longest side.
constexpr double kCell = 0.03;
/// A place extends up to this many cells from its worst cell, over cells with at least kAsBad of that cell's points.
constexpr int kReach = 3;
constexpr double kAsBad = 0.25;
/// Maximum points per place whose causes are determined.
constexpr std::size_t kCausesMax = 200;

/// A wrong point near the surface.
struct Wrong {
    std::uint32_t sample = 0;  ///< index of the point
    int map = -1;
    bool inside = false;  ///< as the collider classifies it
};

std::vector<Wrong> wrongPoints(const TruthSamples& samples, const Collider& collider) {
    std::vector<Wrong> points(samples.near.size());
    forEachIndex(0, points.size(), 512, [&](std::size_t i) {
        const FieldSample sample = evaluate(collider, samples.near[i].position);
        points[i] = {static_cast<std::uint32_t>(i), sample.map, sample.inside()};
    });
    std::erase_if(points, [&](const Wrong& p) { return p.inside == samples.near[p.sample].inside(); });
    return points;
}

/// The wrong points in a grid around the mesh.
class Cells {
  public:
    Cells(const TruthSamples& samples, const Bounds& bounds, const std::vector<Wrong>& wrong)
        : side_(kCell * samples.longest_side), low_(glm::dvec3(bounds.min) - 2.0 * side_) {
        const glm::dvec3 size = glm::dvec3(bounds.max) + 2.0 * side_ - low_;
        count_ = glm::max(glm::ivec3(glm::ceil(size / side_)), 1);
        points_.resize(static_cast<std::size_t>(count_.x) * static_cast<std::size_t>(count_.y) *
                       static_cast<std::size_t>(count_.z));
        for (std::uint32_t i = 0; i < wrong.size(); ++i) {
            points_[indexOf(cellOf(samples.near[wrong[i].sample].position))].push_back(i);
        }
    }

    /// Removes and returns the worst place: indices of wrong points by cell, worst cell first. Empty if none is left.
    std::vector<std::vector<std::uint32_t>> takePlace() {
        const auto worst = std::ranges::max_element(points_, {}, &std::vector<std::uint32_t>::size);
        if (worst->empty()) {
            return {};
        }
        const glm::ivec3 middle = cellAt(static_cast<std::size_t>(worst - points_.begin()));
        const double least = kAsBad * static_cast<double>(worst->size());
        std::vector<std::vector<std::uint32_t>> place;
        std::vector<glm::ivec3> waiting = {middle};
        place.push_back(std::move(*worst));
        worst->clear();
        while (!waiting.empty()) {
            const glm::ivec3 cell = waiting.back();
            waiting.pop_back();
            const auto visit = [&](const glm::ivec3& other) {
                std::vector<std::uint32_t>& points = points_[indexOf(other)];
                const glm::ivec3 offset = glm::abs(other - middle);
                if (points.empty() || std::max({offset.x, offset.y, offset.z}) > kReach) {
                    return;
                }
                // The margin of a place belongs to it but does not extend it.
                if (static_cast<double>(points.size()) >= least) {
                    waiting.push_back(other);
                }
                place.push_back(std::move(points));
                points.clear();
            };
            forEachPoint(glm::max(cell - 1, glm::ivec3(0)), glm::min(cell + 2, count_), visit);
        }
        return place;
    }

  private:
    [[nodiscard]] glm::ivec3 cellOf(const glm::vec3& p) const {
        const glm::dvec3 at = (glm::dvec3(p) - low_) / side_;
        return glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), count_ - 1);
    }
    [[nodiscard]] std::size_t indexOf(const glm::ivec3& cell) const {
        return static_cast<std::size_t>((cell.z * count_.y + cell.y) * count_.x + cell.x);
    }
    [[nodiscard]] glm::ivec3 cellAt(std::size_t index) const {
        const int i = static_cast<int>(index);
        return {i % count_.x, i / count_.x % count_.y, i / count_.x / count_.y};
    }

    double side_;
    glm::dvec3 low_;
    glm::ivec3 count_{1};
    std::vector<std::vector<std::uint32_t>> points_;  // by cell
};

/// Determines the causes of wrong points.
class Causes {
  public:
    Causes(const TruthSamples& samples, const MeshQuery& query, const Sights& sights)
        : samples_(samples), query_(query), sights_(sights) {}

    [[nodiscard]] WrongCause of(const Wrong& wrong) const {
        const TruthPoint& point = samples_.near[wrong.sample];
        const SurfacePoint surface = surfaceBeside(point);
        const double step = kSurfaceStep * samples_.longest_side;
        const glm::dvec3 on_surface = surface.position;
        const glm::dvec3 normal = surface.normal;
        if (!query_.inside(on_surface + step * normal) && !query_.inside(on_surface - step * normal)) {
            return WrongCause::kSheet;
        }
        const bool reached = isReached(point.position);
        if (point.inside() && reached) {
            return WrongCause::kOpen;
        }
        if (wrong.map < 0 || (!point.inside() && !reached && !sights_.isVisible(surface))) {
            return WrongCause::kUnseen;
        }
        const Sight& sight = sights_.maps()[static_cast<std::size_t>(wrong.map)];
        const bool hidden = (!point.inside() && !reached) || !sight.sees(surface);
        return hidden ? WrongCause::kSilhouette : WrongCause::kTexel;
    }

  private:
    /// Returns the nearest surface point, with its normal outwards.
    [[nodiscard]] SurfacePoint surfaceBeside(const TruthPoint& point) const {
        const ClosestPoint closest = query_.closest(point.position);
        glm::dvec3 normal = planeOf(query_.mesh(), closest.triangle).normal;
        normal /= std::sqrt(glm::dot(normal, normal));
        const bool in_front = glm::dot(normal, glm::dvec3(point.position) - closest.point) > 0.0;
        return {closest.point, in_front == point.inside() ? -normal : normal, false};
    }

    /// Whether a line of sight from free space reaches the point.
    [[nodiscard]] bool isReached(const glm::vec3& p) const {
        return std::ranges::any_of(sights_.maps(), [&](const Sight& sight) {
            const std::optional<glm::dvec3> start = sight.reaches(p);
            return start && !query_.inside(glm::vec3(*start));
        });
    }

    const TruthSamples& samples_;
    const MeshQuery& query_;
    const Sights& sights_;
};

/// Returns the index of the largest count, the lowest index if several are equal, and the count.
std::pair<std::size_t, std::size_t> mostFrequent(const std::vector<std::size_t>& counts) {
    const auto most = std::max_element(counts.begin(), counts.end());
    return {static_cast<std::size_t>(most - counts.begin()), *most};
}

/// Returns the wrong point nearest to the mean of its cell.
glm::vec3 middleOf(const std::vector<std::uint32_t>& cell, const std::vector<Wrong>& wrong,
                   const TruthSamples& samples) {
    const auto at = [&](std::uint32_t i) { return glm::dvec3(samples.near[wrong[i].sample].position); };
    glm::dvec3 mean(0.0);
    for (const std::uint32_t i : cell) {
        mean += at(i) / static_cast<double>(cell.size());
    }
    const auto off = [&](std::uint32_t i) { return glm::dot(at(i) - mean, at(i) - mean); };
    const auto nearest = std::ranges::min_element(cell, {}, off);
    return samples.near[wrong[*nearest].sample].position;
}

/// Describes a place without its cause.
WorstPlace describe(const std::vector<std::uint32_t>& points, const std::vector<Wrong>& wrong,
                    const TruthSamples& samples, const Collider& collider) {
    WorstPlace place;
    std::vector<std::size_t> by_map(collider.maps.size() + 1, 0);
    std::size_t inside = 0;
    for (const std::uint32_t i : points) {
        place.box.add(samples.near[wrong[i].sample].position);
        ++by_map[static_cast<std::size_t>(wrong[i].map + 1)];
        inside += wrong[i].inside ? 1U : 0U;
    }
    const auto [map, of_map] = mostFrequent(by_map);
    place.points = points.size();
    place.contribution_percent = percent(points.size(), wrong.size());
    place.false_inside_percent = percent(inside, points.size());
    place.map = static_cast<int>(map) - 1;
    place.map_percent = percent(of_map, points.size());
    return place;
}

}  // namespace

double texelAt(const DepthMap& map, const glm::vec3& p) {
    if (map.projection() == Projection::kLocal) {
        return patchSpacingAt(map, p);
    }
    if (map.projection() == Projection::kOrthographic) {
        return std::max(double{map.object_per_map.x} / map.width, double{map.object_per_map.y} / map.height);
    }
    // A face spans two units at its distance from the centre.
    const glm::vec3 in_map = glm::abs(map.object_to_map.apply(p));
    const double reach = std::max({in_map.x, in_map.y, in_map.z});
    const double half = std::max({map.object_per_map.x, map.object_per_map.y, map.object_per_map.z});
    return 2.0 * half * reach / map.width;
}

std::vector<WorstPlace> worstPlaces(const TruthSamples& samples, const MeshQuery& query, const Sights& sights,
                                    const Collider& collider, std::size_t count) {
    const std::vector<Wrong> wrong = wrongPoints(samples, collider);
    if (wrong.empty()) {
        return {};
    }
    struct Found {
        WorstPlace place;
        std::vector<std::uint32_t> points;
    };
    std::vector<Found> found;
    Cells cells(samples, query.mesh().bounds, wrong);
    for (auto parts = cells.takePlace(); !parts.empty(); parts = cells.takePlace()) {
        std::vector<std::uint32_t> points;
        for (const std::vector<std::uint32_t>& part : parts) {
            points.insert(points.end(), part.begin(), part.end());
        }
        WorstPlace place = describe(points, wrong, samples, collider);
        place.position = middleOf(parts.front(), wrong, samples);
        found.push_back({place, std::move(points)});
    }
    std::ranges::stable_sort(found, std::greater<>(), [](const Found& one) { return one.place.points; });
    found.resize(std::min(found.size(), count));

    const Causes causes(samples, query, sights);
    std::vector<WorstPlace> places;
    for (const auto& [place, points] : found) {
        const std::size_t stride = (points.size() + kCausesMax - 1) / kCausesMax;
        std::vector<WrongCause> seen((points.size() + stride - 1) / stride);
        tbb::parallel_for(std::size_t{0}, seen.size(), [&, &points = points](std::size_t i) {
            seen[i] = causes.of(wrong[points[i * stride]]);
        });
        std::vector<std::size_t> by_cause(kWrongCauses, 0);
        for (const WrongCause cause : seen) {
            ++by_cause[static_cast<std::size_t>(cause)];
        }
        const auto [cause, of_cause] = mostFrequent(by_cause);
        places.push_back(place);
        places.back().cause = static_cast<WrongCause>(cause);
        places.back().cause_percent = percent(of_cause, seen.size());
        if (place.map >= 0) {
            places.back().texel = texelAt(collider.maps[static_cast<std::size_t>(place.map)], place.position);
        }
    }
    return places;
}

}  // namespace relief
