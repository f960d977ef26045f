// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/part_accuracy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "bake/measure/percent.h"
#include "bake/mesh/loops.h"
#include "bake/mesh/surface_sampler.h"

namespace relief {
namespace {

/// A part with a smaller fraction of exposed points is inside other parts.
constexpr double kExposed = 0.05;
/// Relative resolution of float coordinates, with a margin for steps to both sides of a surface.
constexpr double kFloatStep = 1e-6;
/// Maximum halvings of the points' distance from a part that seems to be missing.
constexpr int kCloser = 5;
/// Points that confirm a lost part if fewer points found it.
constexpr std::uint32_t kConfirm = 256;

/// The triangles of each part with cumulative areas.
class PartTriangles {
  public:
    PartTriangles(const TriangleMesh& mesh, const SurfaceParts& parts)
        : triangles_(parts.parts.size(), [&](const auto& visit) {
              for (std::uint32_t i = 0; i < mesh.surfaceTriangles(); ++i) {
                  if (parts.part_of[i] != kNoLabel) {
                      visit(parts.part_of[i], i);
                  }
              }
          }) {
        for (std::size_t part = 0; part < parts.parts.size(); ++part) {
            double sum = 0.0;
            for (const std::uint32_t i : triangles_[part]) {
                sum += length(planeOf(mesh, i).normal);
                up_to_.push_back(sum);
            }
        }
    }

    [[nodiscard]] bool empty(std::size_t part) const { return triangles_[part].empty(); }
    /// Returns the triangle at a fraction of a part's area. \param share  in [0, 1).
    [[nodiscard]] std::uint32_t triangleAt(std::size_t part, double share) const {
        const std::span<const std::uint32_t> triangles = triangles_[part];
        const auto up_to = std::span(up_to_).subspan(triangles_.first(part), triangles.size());
        const auto found = std::upper_bound(up_to.begin(), up_to.end() - 1, share * up_to.back());
        return triangles[static_cast<std::size_t>(found - up_to.begin())];
    }

  private:
    Buckets<std::uint32_t> triangles_;
    std::vector<double> up_to_;  // twice the cumulative area within the part
};

class PartMeter {
  public:
    PartMeter(const MeshQuery& query, const SurfaceParts& parts, const Field& field,
              const PartOptions& options, double min_part)
        : query_(query),
          parts_(parts),
          field_(field),
          options_(options),
          min_part_(min_part),
          triangles_(query.mesh(), parts) {}

    [[nodiscard]] PartAccuracy measure(std::uint32_t part, std::uint32_t points) const {
        const PartAccuracy found = judge(part, points);
        const bool lost = found.state == PartVerdict::kLost || found.state == PartVerdict::kMinor;
        return lost && points < kConfirm ? judge(part, kConfirm) : found;
    }

  private:
    struct Judged {
        PartAccuracy accuracy;
        std::uint32_t inside = 0;  // points that are inside in truth
        std::uint32_t missed = 0;  // of those, points classified as outside

        [[nodiscard]] bool lost() const { return accuracy.state == PartVerdict::kLost; }
        /// Whether most of the part is missing.
        [[nodiscard]] bool absent() const { return 2 * missed >= inside; }
    };

    /// Measures at the part's own scale, and at smaller distances if most of the part seems to be missing: it may be thin.
    [[nodiscard]] PartAccuracy judge(std::uint32_t part, std::uint32_t points) const {
        const double size = parts_.parts[part].size();
        const double least = leastSigma(part);
        Judged found = judgeAt(part, points, std::max(options_.sigma_fraction * size, least));
        for (int k = 0; k < kCloser && !found.lost() && found.accuracy.state != PartVerdict::kHidden &&
                        found.absent() && found.accuracy.sigma > least;
             ++k) {
            found = judgeAt(part, points, std::max(0.5 * found.accuracy.sigma, least));
        }
        const double excess = kNoticeableExcess * min_part_;
        const auto noticed = [&] {
            return size >= min_part_ &&
                   (found.absent() || found.accuracy.sigma >= excess || judgeAt(part, points, excess).lost());
        };
        if (found.lost() && !noticed()) {
            found.accuracy.state = PartVerdict::kMinor;
        }
        return found.accuracy;
    }

    /// Returns the sigma below which points count as on the surface.
    [[nodiscard]] double leastSigma(std::uint32_t part) const {
        return kFloatStep * double{parts_.parts[part].bounds.farthest()};
    }

    [[nodiscard]] Judged judgeAt(std::uint32_t part, std::uint32_t points, double sigma) const {
        Judged judged;
        PartAccuracy& found = judged.accuracy;
        found.part = part;
        found.sigma = sigma;
        const double step = std::max(kSurfaceStep * parts_.parts[part].size(), leastSigma(part));
        if (triangles_.empty(part)) {
            found.state = PartVerdict::kHidden;
            return judged;
        }
        // A shell that is too thick is measured against the face that it should have; against its own face, a lost
        // sheet would be correct.
        const double too_deep = 0.5 * (parts_.parts[part].thickness - parts_.parts[part].target_thickness);
        MersenneRandom random(options_.seed, part);
        std::uint32_t false_inside = 0;
        for (std::uint32_t k = 0; k < points; ++k) {
            const double share = (k + random.uniform()) / points;
            const auto [on, normal] =
                drawOnTriangle(query_.mesh(), triangles_.triangleAt(part, share), random);
            // Braces fix the order of evaluation.
            const glm::dvec3 offset{random.normal(), random.normal(), random.normal()};
            if (query_.inside(on + step * normal) && query_.inside(on - step * normal)) {
                continue;
            }
            ++found.points;
            const glm::vec3 p = on - too_deep * normal + found.sigma * offset;
            const std::optional<FieldValue> value = field_(p);
            const bool inside = value && value->distance < 0.0F;
            const bool beyond = too_deep > 0.0 && dot(offset, normal) > 0.0;
            const bool truth = !beyond && query_.inside(p);
            judged.inside += truth ? 1 : 0;
            judged.missed += truth && !inside ? 1 : 0;
            false_inside += inside && !truth ? 1 : 0;
        }
        found.wrong = {percent(false_inside, found.points), percent(judged.missed, found.points)};
        const double wrong = found.wrong.total();
        found.state = found.points < kExposed * points ? PartVerdict::kHidden
                      : wrong > kPartLost              ? PartVerdict::kLost
                      : wrong > kPartCoarse            ? PartVerdict::kCoarse
                                                       : PartVerdict::kKept;
        return judged;
    }

    const MeshQuery& query_;
    const SurfaceParts& parts_;
    const Field& field_;
    const PartOptions& options_;
    double min_part_;
    PartTriangles triangles_;
};

/// Sums over the parts of each name.
class Groups {
  public:
    explicit Groups(bool materials) : materials_(materials) {}

    /// \param index  sort key of the group.
    void add(std::uint64_t index, const SurfacePart& part, const PartAccuracy& accuracy) {
        const std::string& name = materials_ ? part.material : part.node;
        if (name.empty() || accuracy.points == 0) {
            return;
        }
        Sum& sum = sums_[materials_ ? std::pair{std::uint64_t{0}, name} : std::pair{index, name}];
        sum.group.name = name;
        sum.group.is_material = materials_;
        ++sum.group.parts;
        sum.group.lost += accuracy.state == PartVerdict::kLost ? 1 : 0;
        addBounds(sum.group.bounds, part.bounds);
        sum.area += part.area;
        sum.group.wrong.false_inside += part.area * accuracy.wrong.false_inside;
        sum.group.wrong.false_outside += part.area * accuracy.wrong.false_outside;
    }

    void addTo(std::vector<GroupAccuracy>& groups) {
        if (sums_.size() < 2) {
            return;
        }
        const std::size_t first = groups.size();
        for (auto& [key, sum] : sums_) {
            sum.group.wrong.false_inside /= sum.area;
            sum.group.wrong.false_outside /= sum.area;
            groups.push_back(std::move(sum.group));
        }
        std::ranges::stable_sort(std::span(groups).subspan(first), std::greater<>(),
                                 [](const GroupAccuracy& group) { return group.wrong.total(); });
    }

  private:
    struct Sum {
        GroupAccuracy group;
        double area = 0.0;
    };
    bool materials_;
    std::map<std::pair<std::uint64_t, std::string>, Sum> sums_;
};

/// The order is lost, coarse, minor, kept, then the others.
int rankOf(PartVerdict state) {
    constexpr std::array<int, kPartVerdicts> kRanks = {3, 1, 0, 4, 2, 5};
    return kRanks[static_cast<std::size_t>(state)];
}

bool isMissing(const PartAccuracy& part) {
    return part.wrong.false_outside > part.wrong.false_inside;
}

/// Returns the percentage of points near the exposed surface that minor and coarse parts miss. Excludes surfaces that
/// are too thick: the measurement of the whole mesh includes them, but rarely has points inside a thin part.
double minorMissed(const PartsAccuracy& all, const SurfaceParts& parts) {
    double missed = 0.0;
    double area = 0.0;
    for (const PartAccuracy& one : all.parts) {
        const SurfacePart& part = parts.parts[one.part];
        const bool minor = one.state == PartVerdict::kMinor || one.state == PartVerdict::kCoarse;
        area += one.state == PartVerdict::kHidden ? 0.0 : part.area;
        missed += minor ? part.area * one.wrong.false_outside : 0.0;
    }
    return missed / area;
}

}  // namespace

double defaultMinPart(const SurfaceParts& parts, const std::string& unit, double scale) {
    if (parts.parts.empty()) {
        return 0.0;
    }
    const OutlierParts strays = findOutlierParts(parts.parts);
    Bounds box = strays.rest;
    if (strays.parts.empty()) {
        for (const SurfacePart& part : parts.parts) {
            addBounds(box, part.bounds);
        }
    }
    const double min_part = kNoticeableShare * glm::length(glm::dvec3(box.size()));
    return unit == "m" ? std::min(min_part, kNoticeableMetres / scale) : min_part;
}

void IgnoredParts::add(const IgnoredParts& other, double scale) {
    parts += other.parts;
    lost += other.lost;
    size = std::max(size, scale * other.size);
    thickened += other.thickened;
    unmeasured += other.unmeasured;
}

PartsAccuracy measureParts(const MeshQuery& query, const SurfaceParts& parts, const Field& field,
                           const PartOptions& options) {
    PartsAccuracy all;
    all.min_part = options.min_part.value_or(defaultMinPart(parts, query.mesh().unit, options.scale));
    all.parts.resize(parts.parts.size());
    std::vector<std::uint32_t> order(parts.parts.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto size = [&](std::uint32_t i) { return parts.parts[i].size(); };
    std::ranges::stable_sort(order, std::greater<>(), size);
    for (const std::uint32_t i : order) {
        all.parts[i] = {.part = i, .state = PartVerdict::kUnmeasured, .points = 0, .wrong = {}, .sigma = 0.0};
    }
    order.resize(std::min(order.size(), options.parts_max));
    const auto large = static_cast<std::size_t>(
        std::ranges::partition_point(order, [&](std::uint32_t i) { return size(i) >= all.min_part; }) -
        order.begin());
    const auto each = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        options.points_all / std::max<std::size_t>(large, 1), options.points_min, options.points));
    const PartMeter meter(query, parts, field, options, all.min_part);
    tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t k) {
        all.parts[order[k]] = meter.measure(order[k], k < large ? each : std::min(options.points_min, each));
    });
    all.minor_counts = minorMissed(all, parts) > kGoodPercent;
    if (all.minor_counts && !options.min_part) {
        for (PartAccuracy& one : all.parts) {
            one.state = one.state == PartVerdict::kMinor && isMissing(one) ? PartVerdict::kLost : one.state;
        }
    }
    Groups nodes(false);
    Groups materials(true);
    for (const PartAccuracy& accuracy : all.parts) {
        const SurfacePart& part = parts.parts[accuracy.part];
        nodes.add(part.node_index, part, accuracy);
        materials.add(0, part, accuracy);
        ++all.count[static_cast<std::size_t>(accuracy.state)];
        if (accuracy.state == PartVerdict::kMinor && isMissing(accuracy)) {
            ++all.ignored.lost;
            all.ignored.size = std::max(all.ignored.size, part.size());
        }
    }
    all.ignored.parts = all.parts.size();
    all.ignored.thickened = all.countOf(PartVerdict::kMinor) - all.ignored.lost;
    all.ignored.unmeasured = all.countOf(PartVerdict::kUnmeasured);
    nodes.addTo(all.groups);
    materials.addTo(all.groups);
    // Also weighted by size: a large part that is half wrong is worse than a small part that is all wrong.
    const auto weight = [&](const PartAccuracy& one) {
        return std::pair(rankOf(one.state), -one.wrong.total() * parts.parts[one.part].size());
    };
    std::ranges::stable_sort(all.parts, {}, weight);
    return all;
}

}  // namespace relief
