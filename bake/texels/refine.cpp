// SPDX-License-Identifier: Apache-2.0
#include "bake/texels/refine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "bake/mesh/loops.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/texels/deep_solid.h"
#include "bake/texels/plane_fit.h"
#include "formats/plane.h"
#include "formats/row_spans.h"
#include "formats/texel.h"

namespace relief {
namespace {

constexpr double kDepthCodes = kDepthSteps;
/// The least gain of a change, in points: with few points per texel, less is noise.
constexpr double kMargin = 3.0;
/// Steeper planes reach deep into the solid, where no points are drawn; only the fit, which has the last surfaces on its
/// rays too, may choose them.
constexpr double kSteepest = 0.2;
constexpr std::size_t kNormalsTried = 12;
/// The share of points of the trial, and their least number.
constexpr double kTrialShare = 0.125;
constexpr double kTrialPointsMin = 65'536.0;
constexpr std::uint16_t kSettledVotes = 4;
constexpr std::int32_t kAbstains = -1;
constexpr std::int32_t kOutside = -2;

/// One end of a texel as it is stored.
struct Code {
    std::uint16_t normal = 0;
    std::uint16_t depth = 0;  ///< 0: empty
    friend bool operator==(const Code&, const Code&) = default;
};

struct Ray : TexelRay {
    double length = 0.0;  ///< of `direction`
};

/// One end of a texel, in object space.
struct Plane {
    glm::dvec3 normal;
    double offset;  ///< n·(P − O) of its points
    glm::dvec3 origin;
    /// p is outside.
    [[nodiscard]] bool sees(const glm::dvec3& p) const { return dot(normal, p - origin) - offset >= 0.0; }
};

/// The votes of a map's texels, end by end.
class TexelVotes {
  public:
    explicit TexelVotes(DepthMap& map)
        : map_(map),
          changeable_(map.decode == Decode::kPlane && map.format != MapFormat::kFloat32 &&
                      map.format != MapFormat::kFrontBackHalf),
          depth_max_(map.projection() == Projection::kCube ? double{kCubeDepthMax} : 1.0) {
        range_ = standingRange(map.projection(), map.object_per_map, map.width, map.height);
        const TexelRay first = texelRay(map, 0, 0, 0);
        if (map.projection() == Projection::kOrthographic) {
            first_ = rayOf(first);
            column_step_ = texelRay(map, 0, 1, 0).origin - first.origin;
            row_step_ = texelRay(map, 0, 0, 1).origin - first.origin;
        }
    }

    [[nodiscard]] bool changeable() const { return changeable_; }
    /// In a gap, a point is outside only by both ends.
    [[nodiscard]] bool isGap() const { return map_.compare == Compare::kGap; }
    [[nodiscard]] int ends() const { return isFrontBack(map_.format) ? 2 : 1; }
    [[nodiscard]] std::size_t texels() const {
        return std::size_t{map_.faceCount()} * map_.width * map_.height;
    }

    /// The texel that votes on p, kAbstains or kOutside; as vote() of depth_map.h.
    [[nodiscard]] std::int32_t locate(const glm::vec3& p) const {
        const glm::vec3 q = map_.object_to_map.apply(p);
        const auto width = static_cast<float>(map_.width);
        const std::int32_t beyond = map_.encloses ? kOutside : kAbstains;
        if (map_.projection() == Projection::kOrthographic) {
            const float x = q.x * width;
            const float y = q.y * static_cast<float>(map_.height);
            if (!(x >= 1.0F && y >= 1.0F && x < width - 1.0F && y < static_cast<float>(map_.height) - 1.0F &&
                  q.z >= 0.0F && q.z <= 1.0F)) {
                return beyond;
            }
            return static_cast<std::int32_t>(y) * static_cast<std::int32_t>(map_.width) +
                   static_cast<std::int32_t>(x);
        }
        if (!(std::max({std::abs(q.x), std::abs(q.y), std::abs(q.z)}) <= 1.0F)) {
            return beyond;
        }
        const float radius = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
        const CubeCoordinates at = cubeCoordinates(radius > 0.0F ? q / radius : glm::vec3(1.0F, 0.0F, 0.0F));
        const auto x = std::min(static_cast<std::uint32_t>(at.s * width), map_.width - 1);
        const auto y = std::min(static_cast<std::uint32_t>(at.t * width), map_.width - 1);
        return static_cast<std::int32_t>((at.face * map_.width + y) * map_.width + x);
    }

    [[nodiscard]] Ray ray(std::size_t texel) const {
        const auto at = static_cast<std::uint32_t>(texel);  // 32-bit division is faster
        const std::uint32_t x = at % map_.width;
        const std::uint32_t row = at / map_.width;
        if (map_.projection() == Projection::kOrthographic) {
            Ray ray = first_;
            ray.origin += static_cast<double>(x) * column_step_ + static_cast<double>(row) * row_step_;
            return ray;
        }
        return rayOf(texelRay(map_, row / map_.width, x, row % map_.width));
    }

    [[nodiscard]] Code code(std::size_t texel, int end) const {
        const std::byte* bytes = map_.texels.data() + texel * texelSize(map_.format);
        if (isFrontBack(map_.format)) {
            std::uint16_t words[4];
            std::memcpy(words, bytes, sizeof(words));
            return {words[end], words[2 + end]};
        }
        const auto byte = [&](int i) { return std::to_integer<unsigned>(bytes[i]); };
        return {static_cast<std::uint16_t>(byte(0) << 8U | byte(1)),
                static_cast<std::uint16_t>(byte(2) << 8U | byte(3))};
    }

    void setCode(std::size_t texel, int end, const Code& code) {
        std::byte* bytes = map_.texels.data() + texel * texelSize(map_.format);
        if (isFrontBack(map_.format)) {
            std::memcpy(bytes + 2 * end, &code.normal, 2);
            std::memcpy(bytes + 4 + 2 * end, &code.depth, 2);
            return;
        }
        bytes[0] = static_cast<std::byte>(code.normal >> 8);
        bytes[1] = static_cast<std::byte>(code.normal & 0xff);
        bytes[2] = static_cast<std::byte>(code.depth >> 8);
        bytes[3] = static_cast<std::byte>(code.depth & 0xff);
    }

    [[nodiscard]] bool stands(const glm::dvec3& normal, const Ray& ray) const {
        return std::abs(dot(normal, ray.direction)) < double{kStandingCosine} * ray.length;
    }

    /// n·(P − O) of the points on a plane.
    [[nodiscard]] double offsetOf(const Code& code, const glm::dvec3& normal, const Ray& ray) const {
        const double depth = (code.depth - 1) / kDepthCodes;
        return stands(normal, ray) ? (2.0 * depth - 1.0) * range_
                                   : depth * depth_max_ * dot(normal, ray.direction);
    }

    /// The nearest code of an offset; depth 0 if it is out of range.
    [[nodiscard]] Code codeOf(std::uint16_t normal_code, const glm::dvec3& normal, double offset,
                              const Ray& ray) const {
        const double unit = stands(normal, ray) ? 0.5 * (offset / range_ + 1.0)
                                                : offset / dot(normal, ray.direction) / depth_max_;
        const double scaled = std::floor(unit * kDepthCodes + 0.5);
        if (!(scaled >= 0.0 && scaled <= kDepthCodes)) {
            return {};
        }
        return {normal_code, static_cast<std::uint16_t>(1 + static_cast<int>(scaled))};
    }

    /// Of a code that is not empty.
    [[nodiscard]] Plane planeOf(const Code& code, const Ray& ray) const {
        const glm::dvec3 normal(decodedNormals()[code.normal]);
        return {normal, offsetOf(code, normal, ray), ray.origin};
    }

    /// Number of a texel's votes for outside: one per end, or one per gap.
    [[nodiscard]] int outsideVotes(std::size_t texel, const Ray& ray, const glm::dvec3& p) const {
        int votes = 0;
        for (int end = 0; end < ends(); ++end) {
            const Code here = code(texel, end);
            votes += here.depth != 0 && planeOf(here, ray).sees(p) ? 1 : 0;
        }
        return isGap() ? votes / 2 : votes;
    }

    /// The texel is empty, and that means outside.
    [[nodiscard]] bool emptyIsOutside(std::size_t texel) const {
        return map_.empty_is_outside && code(texel, 0).depth == 0 &&
               (ends() == 1 || code(texel, 1).depth == 0);
    }

    /// Number of votes for p outside: one per end, or one per gap.
    [[nodiscard]] int votesOn(const glm::vec3& p) const {
        if (!changeable_) {
            const std::optional<Vote> v = vote(map_, p);
            return v && v->distance >= 0.0F ? 1 : 0;
        }
        const std::int32_t texel = locate(p);
        if (texel < 0) {
            return texel == kOutside ? 1 : 0;
        }
        const auto at = static_cast<std::size_t>(texel);
        return emptyIsOutside(at) ? 1 : outsideVotes(at, ray(at), p);
    }

    /// The normal faces the viewer of this end, or stands, and is not too steep.
    [[nodiscard]] bool allowed(const glm::dvec3& normal, const Ray& ray, int end, double steepest) const {
        const bool sees_far = map_.compare == Compare::kGreater || end == 1;
        const double cosine = dot(normal, ray.direction) / ray.length * (sees_far ? 1.0 : -1.0);
        const bool in_gap = std::abs(std::abs(cosine) - double{kStandingCosine}) < 1e-4;
        return std::abs(cosine) >= steepest && !in_gap && (cosine > 0.0 || (stands(normal, ray) && !isGap()));
    }

    [[nodiscard]] const DepthMap& map() const { return map_; }

  private:
    static Ray rayOf(const TexelRay& ray) { return {ray, relief::length(ray.direction)}; }

    DepthMap& map_;
    bool changeable_;
    double depth_max_;
    double range_ = 0.0;
    Ray first_{};
    glm::dvec3 column_step_{0.0};
    glm::dvec3 row_step_{0.0};
};

/// A point that the texel decides.
struct Decided {
    glm::dvec3 from_ray;  ///< P − O
    glm::vec3 normal;
    bool inside;
};

/// The search for one end's plane by the points that it decides.
class PlaneChoice {
  public:
    PlaneChoice(const TexelVotes& votes, const MeshQuery& query, const RefineOptions& options)
        : votes_(votes),
          options_(options),
          deep_(query, votes.map()),
          margin_(kMargin * std::max(options.false_inside, 0.5 * options.false_outside)) {}

    std::vector<Decided> points;

    void setTexel(std::size_t texel) {
        deep_.setTexel(texel);
        within_ = DeepSolid::kAllDepths;
    }
    /// In a gap, the other end limits the depths.
    void setOther(const Code& other, const Ray& ray) {
        const glm::dvec3 normal(decodedNormals()[other.normal]);
        within_ = deep_.depthsOf(normal, votes_.offsetOf(other, normal, ray));
    }

    Code best(const Code& current, const Ray& ray, int end) {
        ray_ = &ray;
        end_ = end;
        best_ = current;
        const glm::dvec3 normal(decodedNormals()[current.normal]);
        best_cost_ = costOf(normal, votes_.offsetOf(current, normal, ray)) - margin_;
        if (best_cost_ < 0.0) {
            return current;
        }
        steepest_ = std::min(kSteepest, std::abs(dot(normal, ray.direction)) / ray.length) - 1e-9;
        tried_count_ = 0;
        tryCode(current.normal);
        glm::vec3 sum(0.0F);
        for (const Decided& point : points) {
            sum += point.normal;
        }
        const float length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
        if (length > 0.0F) {
            tryCode(packNormal(encodeNormal(sum / length)));
        }
        const std::size_t count = std::min(points.size(), kNormalsTried);
        for (std::size_t i = 0; i < count; ++i) {
            tryCode(packNormal(encodeNormal(points[i * points.size() / count].normal)));
        }
        for (int step = 4; step > 0 && best_cost_ > 0.0; step /= 2) {
            forNeighbours(unpackNormal(best_.normal), step,
                          [&](NormalIndex index) { tryCode(packNormal(index)); });
        }
        return best_;
    }

  private:
    [[nodiscard]] double priceOf(bool inside) const {
        return inside ? options_.false_outside : options_.false_inside;
    }

    [[nodiscard]] double costOf(const glm::dvec3& normal, double offset) const {
        double cost = 0.0;
        for (const Decided& point : points) {
            const bool outside = dot(normal, point.from_ray) >= offset;
            cost += outside == point.inside ? priceOf(point.inside) : 0.0;
        }
        return cost;
    }

    /// The best offset for a normal lies between two neighbouring projections of the points on it.
    void tryCode(std::uint16_t code) {
        const auto tried = std::span(tried_).first(tried_count_);
        if (tried_count_ == tried_.size() || std::ranges::find(tried, code) != tried.end()) {
            return;
        }
        tried_[tried_count_++] = code;
        const glm::dvec3 normal(decodedNormals()[code]);
        if (!votes_.allowed(normal, *ray_, end_, steepest_)) {
            return;
        }
        along_.clear();
        double cost = 0.0;
        for (const Decided& point : points) {
            along_.emplace_back(dot(normal, point.from_ray), point.inside);
            cost += point.inside ? priceOf(true) : 0.0;
        }
        std::ranges::sort(along_);
        // From all outside, one point after the other falls behind the plane.
        double least = best_cost_;
        double offset = 0.0;
        for (std::size_t i = 0; i < along_.size(); ++i) {
            cost += along_[i].second ? -priceOf(true) : priceOf(false);
            if (cost < least && i + 1 < along_.size()) {
                least = cost;
                offset = 0.5 * (along_[i].first + along_[i + 1].first);
            }
        }
        if (!(least < best_cost_)) {
            return;
        }
        const Code quantised = votes_.codeOf(code, normal, offset, *ray_);
        if (quantised.depth == 0) {
            return;
        }
        const double stored = votes_.offsetOf(quantised, normal, *ray_);
        const double real = costOf(normal, stored);
        if (real < best_cost_ && !deep_.cutBy(normal, stored, within_)) {
            best_cost_ = real;
            best_ = quantised;
        }
    }

    const TexelVotes& votes_;
    const RefineOptions& options_;
    DeepSolid deep_;
    LineSpan within_ = DeepSolid::kAllDepths;
    double margin_;
    const Ray* ray_ = nullptr;
    int end_ = 0;
    double steepest_ = 0.0;
    Code best_;
    double best_cost_ = 0.0;
    std::array<std::uint16_t, 48> tried_{};
    std::size_t tried_count_ = 0;
    std::vector<std::pair<double, bool>> along_;
};

class Refinement {
  public:
    Refinement(Collider& collider, const MeshQuery& query, const RefineOptions& options)
        : query_(query), options_(options) {
        for (DepthMap& map : collider.maps) {
            maps_.emplace_back(map);
        }
    }

    /// Adds points that are not settled.
    void add(std::vector<LabelledPoint> points) {
        const std::size_t first = points_.size();
        if (points_.empty()) {
            points_ = std::move(points);
        } else {
            points_.insert(points_.end(), points.begin(), points.end());
        }
        countVotes(first);
    }

    /// \return the share of the errors at all points so far, weighted, that a sweep over the maps corrects.
    double sweep() {
        const double before = costOfMistakes();
        for (TexelVotes& map : maps_) {
            if (map.changeable()) {
                refine(map);
            }
        }
        return before > 0.0 ? 1.0 - costOfMistakes() / before : 0.0;
    }

  private:
    /// Counts the votes on the points from `first` on, and drops those that are settled.
    void countVotes(std::size_t first) {
        outside_votes_.resize(points_.size(), 0);
        for (const TexelVotes& map : maps_) {
            countVotes(map, first);
        }
        std::size_t kept = first;
        for (std::size_t i = first; i < points_.size(); ++i) {
            if (!settled(i)) {
                points_[kept] = points_[i];
                outside_votes_[kept] = outside_votes_[i];
                ++kept;
            }
        }
        points_.resize(kept);
        outside_votes_.resize(kept);
    }

    void countVotes(const TexelVotes& map, std::size_t first) {
        forEachIndex(first, points_.size(), 4096, [&](std::size_t i) {
            if (!settled(i)) {
                outside_votes_[i] =
                    static_cast<std::uint16_t>(outside_votes_[i] + map.votesOn(points_[i].position));
            }
        });
    }

    /// Free points that many ends have outside need no texel to be refined for them.
    [[nodiscard]] bool settled(std::size_t i) const {
        return !points_[i].inside && outside_votes_[i] >= kSettledVotes;
    }
    [[nodiscard]] double costOfMistakes() const {
        double cost = 0.0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            if (points_[i].inside != (outside_votes_[i] == 0)) {
                cost += points_[i].inside ? options_.false_outside : options_.false_inside;
            }
        }
        return cost;
    }

    void refine(TexelVotes& map) {
        texel_of_.resize(points_.size());
        forEachIndex(0, points_.size(), 4096,
                     [&](std::size_t i) { texel_of_[i] = map.locate(points_[i].position); });
        const Buckets<std::uint32_t> members(map.texels(), [&](const auto& visit) {
            for (std::uint32_t i = 0; i < texel_of_.size(); ++i) {
                if (texel_of_[i] >= 0) {
                    visit(static_cast<std::size_t>(texel_of_[i]), i);
                }
            }
        });
        tbb::parallel_for(tbb::blocked_range<std::size_t>(0, map.texels(), 256), [&](const auto& range) {
            PlaneChoice choice(map, query_, options_);
            for (std::size_t texel = range.begin(); texel != range.end(); ++texel) {
                if (static_cast<double>(members[texel].size()) > kMargin) {
                    refineTexel(map, texel, members[texel], choice);
                }
            }
        });
    }

    void refineTexel(TexelVotes& map, std::size_t texel, std::span<const std::uint32_t> members,
                     PlaneChoice& choice) {
        const Ray ray = map.ray(texel);
        choice.setTexel(texel);
        for (int end = 0; end < map.ends(); ++end) {
            const Code current = map.code(texel, end);
            const Code other = map.isGap() ? map.code(texel, 1 - end) : current;
            if (current.depth == 0 || other.depth == 0) {
                continue;
            }
            const Plane plane = map.planeOf(current, ray);
            const Plane other_plane = map.planeOf(other, ray);
            if (map.isGap()) {
                choice.setOther(other, ray);
            }
            // A point that the other end of a gap has inside is not decided here.
            const auto mayDecide = [&](std::uint32_t i) {
                return !map.isGap() || other_plane.sees(points_[i].position);
            };
            choice.points.clear();
            for (const std::uint32_t i : members) {
                const int own = plane.sees(points_[i].position) ? 1 : 0;
                if (mayDecide(i) && outside_votes_[i] == own) {
                    choice.points.push_back(
                        {glm::dvec3(points_[i].position) - ray.origin, points_[i].normal, points_[i].inside});
                }
            }
            const Code best = choice.best(current, ray, end);
            if (best == current) {
                continue;
            }
            map.setCode(texel, end, best);
            const Plane better = map.planeOf(best, ray);
            for (const std::uint32_t i : members) {
                if (!mayDecide(i)) {
                    continue;
                }
                const int before = plane.sees(points_[i].position) ? 1 : 0;
                const int after = better.sees(points_[i].position) ? 1 : 0;
                outside_votes_[i] = static_cast<std::uint16_t>(outside_votes_[i] + after - before);
            }
        }
    }

    const MeshQuery& query_;
    const RefineOptions& options_;
    std::vector<LabelledPoint> points_;
    std::vector<std::uint16_t> outside_votes_;  // by point
    std::vector<std::int32_t> texel_of_;        // by point, in the current map
    std::vector<TexelVotes> maps_;
};

/// Mean side of all texels, object units.
double meanTexel(const Collider& collider) {
    double texels = 0.0;
    double sides = 0.0;
    for (const DepthMap& map : collider.maps) {
        const auto count = static_cast<double>(map.faceCount()) * map.width * map.height;
        const double across = map.projection() == Projection::kCube ? 2.0 : 1.0;
        const glm::vec3& size = map.object_per_map;
        texels += count;
        sides += count * across * std::sqrt(double{size.x} / map.width * double{size.y} / map.height);
    }
    return sides / texels;
}

}  // namespace

void refineTexels(Collider& collider, const MeshQuery& query, const RefineOptions& options) {
    double ends = 0.0;
    for (const DepthMap& map : collider.maps) {
        ends += static_cast<double>(gpuBytes(map)) / 4.0;
    }
    const double count =
        std::clamp(ends * options.points_per_texel, double{kRefinePointsMin}, double{kRefinePointsMax});
    const double far = options.sigma_share * query.mesh().bounds.longestSide();
    const double near = std::min(options.sigma_texels * meanTexel(collider), far);
    std::uint64_t seed = options.seed;
    Refinement refinement(collider, query, options);
    const auto draw = [&](double share) {
        const auto half = static_cast<std::size_t>(0.5 * share * count);
        refinement.add(drawNearSurface(query, half, near, seed++));
        refinement.add(drawNearSurface(query, half, far, seed++));
    };
    const double trial = std::max(kTrialShare, std::min(kTrialPointsMin / count, 1.0));
    draw(trial);
    const double mended = refinement.sweep();
    if (mended < options.worth_mending) {
        return;
    }
    draw((mended < options.worth_all ? 0.5 : 1.0) * (1.0 - trial));
    for (int sweep = 0; sweep < options.sweeps; ++sweep) {
        refinement.sweep();
    }
}

}  // namespace relief
