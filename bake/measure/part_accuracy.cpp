// SPDX-License-Identifier: Apache-2.0
#include "bake/measure/part_accuracy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <functional>
#include <glm/common.hpp>
#include <map>
#include <span>
#include <utility>

#include "bake/measure/percent.h"
#include "bake/mesh/loops.h"
#include "bake/mesh/surface_sampler.h"

namespace relief {
namespace {

constexpr double kDetailShare = 1e-3;
constexpr double kDetailMetres = 0.1;
/// A part with a smaller share of exposed points lies inside others.
constexpr double kExposed = 0.05;
/// Resolution of float coordinates, relative, with room for a step to either side of a surface.
constexpr double kFloatStep = 1e-6;

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
    /// \param share  in [0, 1): of the part's area before the triangle.
    [[nodiscard]] std::uint32_t triangleAt(std::size_t part, double share) const {
        const std::span<const std::uint32_t> triangles = triangles_[part];
        const auto up_to = std::span(up_to_).subspan(triangles_.first(part), triangles.size());
        const auto found = std::upper_bound(up_to.begin(), up_to.end() - 1, share * up_to.back());
        return triangles[static_cast<std::size_t>(found - up_to.begin())];
    }

  private:
    Buckets<std::uint32_t> triangles_;
    std::vector<double> up_to_;  // twice the area, within the part
};

class PartMeter {
  public:
    PartMeter(const MeshQuery& query, const SurfaceParts& parts, const Field& field,
              const PartOptions& options, std::uint32_t points)
        : query_(query),
          parts_(parts),
          field_(field),
          options_(options),
          points_(points),
          triangles_(query.mesh(), parts) {}

    [[nodiscard]] PartAccuracy measure(std::uint32_t part) const {
        PartAccuracy found;
        found.part = part;
        const Bounds& bounds = parts_.parts[part].bounds;
        const double size = parts_.parts[part].size();
        const glm::vec3 far = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
        const double least = kFloatStep * double{std::max({far.x, far.y, far.z})};
        found.sigma = std::max(options_.sigma_share * size, least);
        const double step = std::max(kSurfaceStep * size, least);
        if (triangles_.empty(part)) {
            found.state = PartVerdict::kHidden;
            return found;
        }
        // Too thick a shell is judged by the face that it should have: by its own, a lost sheet would be right.
        const double too_deep = 0.5 * (parts_.parts[part].thickness - parts_.parts[part].right_thickness);
        MersenneRandom random(options_.seed, part);
        std::uint32_t false_inside = 0;
        std::uint32_t false_outside = 0;
        for (std::uint32_t k = 0; k < points_; ++k) {
            const double share = (k + random.uniform()) / points_;
            const auto [on, normal] =
                drawOnTriangle(query_.mesh(), triangles_.triangleAt(part, share), random);
            // Braces, as compilers choose the order of a call's arguments.
            const glm::dvec3 offset{random.normal(), random.normal(), random.normal()};
            if (query_.inside(on + step * normal) && query_.inside(on - step * normal)) {
                continue;
            }
            ++found.points;
            const glm::vec3 p = on - too_deep * normal + found.sigma * offset;
            const std::optional<FieldValue> value = field_(p);
            const bool inside = value && value->distance < 0.0F;
            const bool beyond = too_deep > 0.0 && dot(offset, normal) > 0.0;
            if (const bool truth = !beyond && query_.inside(p); truth != inside) {
                ++(inside ? false_inside : false_outside);
            }
        }
        found.wrong = {percent(false_inside, found.points), percent(false_outside, found.points)};
        const double wrong = found.wrong.total();
        found.state = found.points < kExposed * points_ ? PartVerdict::kHidden
                      : wrong > kPartLost               ? PartVerdict::kLost
                      : wrong > kPartCoarse             ? PartVerdict::kCoarse
                                                        : PartVerdict::kHeld;
        return found;
    }

  private:
    const MeshQuery& query_;
    const SurfaceParts& parts_;
    const Field& field_;
    const PartOptions& options_;
    std::uint32_t points_;
    PartTriangles triangles_;
};

/// Sums over the parts of each name.
class Groups {
  public:
    explicit Groups(bool materials) : materials_(materials) {}

    /// \param index  sorts the groups.
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

/// Lost, coarse, held, then the others.
int rankOf(PartVerdict state) {
    constexpr std::array<int, kPartVerdicts> kRanks = {2, 1, 0, 3, 4, 5};
    return kRanks[static_cast<std::size_t>(state)];
}

}  // namespace

double defaultDetail(const SurfaceParts& parts, const std::string& unit) {
    double largest = 0.0;
    for (const SurfacePart& part : parts.parts) {
        largest = std::max(largest, part.size());
    }
    return unit == "m" ? std::min(kDetailShare * largest, kDetailMetres) : kDetailShare * largest;
}

PartsAccuracy measureParts(const MeshQuery& query, const SurfaceParts& parts, const Field& field,
                           const PartOptions& options) {
    PartsAccuracy all;
    all.detail = options.detail.value_or(defaultDetail(parts, query.mesh().unit));
    all.parts.resize(parts.parts.size());
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < parts.parts.size(); ++i) {
        const bool small = parts.parts[i].size() < all.detail;
        all.parts[i].part = i;
        all.parts[i].state = small ? PartVerdict::kSmall : PartVerdict::kRest;
        if (!small) {
            order.push_back(i);
        }
    }
    std::ranges::stable_sort(order, std::greater<>(), [&](std::uint32_t i) { return parts.parts[i].size(); });
    order.resize(std::min(order.size(), options.parts_max));
    const auto each = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        options.points_all / std::max<std::size_t>(order.size(), 1), options.points_min, options.points));
    const PartMeter meter(query, parts, field, options, each);
    tbb::parallel_for(std::size_t{0}, order.size(),
                      [&](std::size_t k) { all.parts[order[k]] = meter.measure(order[k]); });
    Groups nodes(false);
    Groups materials(true);
    for (const PartAccuracy& accuracy : all.parts) {
        const SurfacePart& part = parts.parts[accuracy.part];
        nodes.add(part.node_index, part, accuracy);
        materials.add(0, part, accuracy);
        ++all.count[static_cast<std::size_t>(accuracy.state)];
    }
    nodes.addTo(all.groups);
    materials.addTo(all.groups);
    // By size too: a large part that is half wrong is worse than a small one that is all wrong.
    const auto weight = [&](const PartAccuracy& one) {
        return std::pair(rankOf(one.state), -one.wrong.total() * parts.parts[one.part].size());
    };
    std::ranges::stable_sort(all.parts, {}, weight);
    return all;
}

}  // namespace relief
