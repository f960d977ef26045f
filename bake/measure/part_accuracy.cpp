#include "bake/measure/part_accuracy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <map>
#include <numeric>
#include <utility>

#include "bake/measure/percent.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

constexpr double kDetailShare = 1e-3;
constexpr double kDetailMetres = 0.1;
/// A part of whose points fewer are exposed lies inside others.
constexpr double kExposed = 0.05;
/// What a coordinate's float resolves, in units of its size, with room for a step to either side of a surface.
constexpr double kFloatStep = 1e-6;

/// The triangles of each part, and their areas summed up.
class PartTriangles {
  public:
    PartTriangles(const TriangleMesh& mesh, const SurfaceParts& parts) : begin_(parts.parts.size() + 1, 0) {
        for (std::size_t i = 0; i < mesh.surfaceTriangles(); ++i) {
            if (parts.part_of[i] != kNoLabel) {
                ++begin_[parts.part_of[i] + 1];
            }
        }
        std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
        triangles_.resize(begin_.back());
        up_to_.resize(begin_.back());
        std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
        for (std::uint32_t i = 0; i < mesh.surfaceTriangles(); ++i) {
            const std::uint32_t part = parts.part_of[i];
            if (part == kNoLabel) {
                continue;
            }
            const glm::dvec3 normal = planeOf(mesh, i).normal;
            const std::size_t at = next[part]++;
            const double before = at == begin_[part] ? 0.0 : up_to_[at - 1];
            triangles_[at] = i;
            up_to_[at] = before + std::sqrt(dot(normal, normal));
        }
    }

    [[nodiscard]] bool empty(std::size_t part) const { return begin_[part] == begin_[part + 1]; }
    /// \param share  in [0, 1): of the part's area, how much lies before the triangle.
    [[nodiscard]] std::uint32_t triangleAt(std::size_t part, double share) const {
        const auto first = up_to_.begin() + static_cast<std::ptrdiff_t>(begin_[part]);
        const auto last = up_to_.begin() + static_cast<std::ptrdiff_t>(begin_[part + 1]) - 1;
        const auto found = std::upper_bound(first, last, share * *last);
        return triangles_[static_cast<std::size_t>(found - up_to_.begin())];
    }

  private:
    std::vector<std::size_t> begin_;
    std::vector<std::uint32_t> triangles_;
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
        const std::pair thickness(parts_.parts[part].thickness, parts_.parts[part].right_thickness);
        MersenneRandom random(options_.seed * 0x9e3779b97f4a7c15U + part);
        std::uint32_t false_inside = 0;
        std::uint32_t false_outside = 0;
        for (std::uint32_t k = 0; k < points_; ++k) {
            const double share = (k + random.uniform()) / points_;
            const auto [on, normal] =
                drawOnTriangle(query_.mesh(), triangles_.triangleAt(part, share), random);
            // In braces: the arguments of a call are evaluated in an order that the compiler chooses.
            const glm::dvec3 offset{random.normal(), random.normal(), random.normal()};
            if (query_.inside(on + step * normal) && query_.inside(on - step * normal)) {
                continue;
            }
            ++found.points;
            const glm::vec3 p = on + found.sigma * offset;
            const std::optional<FieldValue> value = field_(p);
            const bool inside = value && value->distance < 0.0F;
            // The face of a shell lies half of its thickness off the sheet.
            const double off_sheet = 0.5 * thickness.first + found.sigma * dot(offset, normal);
            const bool beyond = thickness.second < thickness.first && off_sheet > 0.5 * thickness.second;
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

/// Adds up parts of one name.
class Groups {
  public:
    explicit Groups(bool materials) : materials_(materials) {}

    /// \param index  of the name, in whose order groups come.
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
        sum.group.bounds.add(part.bounds.min);
        sum.group.bounds.add(part.bounds.max);
        sum.area += part.area;
        sum.group.wrong.false_inside += part.area * accuracy.wrong.false_inside;
        sum.group.wrong.false_outside += part.area * accuracy.wrong.false_outside;
    }

    void addTo(std::vector<GroupAccuracy>& groups) {
        if (sums_.size() < 2) {
            return;
        }
        const auto first = static_cast<std::ptrdiff_t>(groups.size());
        for (auto& [key, sum] : sums_) {
            sum.group.wrong.false_inside /= sum.area;
            sum.group.wrong.false_outside /= sum.area;
            groups.push_back(std::move(sum.group));
        }
        std::stable_sort(
            groups.begin() + first, groups.end(),
            [](const GroupAccuracy& a, const GroupAccuracy& b) { return a.wrong.total() > b.wrong.total(); });
    }

  private:
    struct Sum {
        GroupAccuracy group;
        double area = 0.0;
    };
    bool materials_;
    std::map<std::pair<std::uint64_t, std::string>, Sum> sums_;
};

/// Lost, coarse, held; then those that are not measured.
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
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return parts.parts[a].size() > parts.parts[b].size();
    });
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
    // A large part that is half wrong is worse than a small one that is all wrong.
    const auto weight = [&](const PartAccuracy& one) {
        return std::pair(rankOf(one.state), -one.wrong.total() * parts.parts[one.part].size());
    };
    std::stable_sort(all.parts.begin(), all.parts.end(),
                     [&](const PartAccuracy& a, const PartAccuracy& b) { return weight(a) < weight(b); });
    return all;
}

}  // namespace relief
