// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/plane_fit.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "bake/mesh/triangle_plane.h"
#include "bake/named_maps/highest_below.h"
#include "formats/texel.h"

namespace relief {
namespace {

constexpr double kDepthCodes = kDepthSteps;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Below this cosine, a plane would cut off the part between the outermost ray that hits the surface and the edge of
/// the surface, so the edge has to support it. Flatter planes pass over this part, and would lose more than they gain
/// from the support.
constexpr double kSteepCosine = 0.35;
/// Steeper planes cut deep: a surface that rises between the rays of the footprint and the rim of the texel would leave
/// a pit in the solid. The surface points of the rays around the footprint must therefore lie behind them, too.
constexpr double kDeepCosine = 0.1;

std::uint16_t codeOf(const glm::dvec3& normal) {
    return packNormal(encodeNormal(glm::vec3(normal)));
}

/// SIMD: each lane rounds like a scalar.
using Lanes [[gnu::vector_size(16)]] = double;
constexpr std::size_t kLanes = 2;

/// The rays of a footprint as a structure of arrays, because every candidate plane visits them all.
class RayTable {
  public:
    RayTable(std::span<const FootprintRay> rays, const glm::dvec3& origin, double u_max)
        : count_(rays.size()), blocks_((rays.size() + kLanes - 1) / kLanes), u_max_(u_max) {
        assert(count_ <= kFootprintRaysMax);
        for (std::size_t i = 0; i < blocks_ * kLanes; ++i) {
            const FootprintRay& ray = rays[std::min(i, count_ - 1)];  // a repeated ray changes no maximum
            Block& block = table_[i / kLanes];
            const std::size_t lane = i % kLanes;
            const glm::dvec3 start = ray.origin - origin;
            for (int axis = 0; axis < 3; ++axis) {
                block.start[axis][lane] = start[axis];
                block.direction[axis][lane] = ray.direction[axis];
            }
            const bool meets = ray.u >= 0.0;
            block.least[lane] = meets ? -kInfinity : kInfinity;
            block.first[lane] = ray.u;
            block.free_end[lane] = meets ? ray.u : u_max;
        }
    }

    /// Sets the plane normal for subsequent calls.
    void setNormal(const glm::dvec3& n) {
        for (std::size_t b = 0; b < blocks_; ++b) {
            Block& block = table_[b];
            block.along = n.x * block.direction[0] + (n.y * block.direction[1] + n.z * block.direction[2]);
            block.at_start = n.x * block.start[0] + (n.y * block.start[1] + n.z * block.start[2]);
        }
    }

    /// Returns the minimum offset of a plane with no surface point in front of it. A plane that faces away from a ray
    /// of a cube must not cut the part behind the surface on that ray, whose end is unknown.
    [[nodiscard]] double support() const {
        const Lanes end = Lanes{} + u_max_;
        Lanes most = {-kInfinity, -kInfinity};
        for (std::size_t b = 0; b < blocks_; ++b) {
            const Block& block = table_[b];
            const Lanes u = block.along > 0.0 ? end : block.first;
            const Lanes value = block.at_start + u * block.along;
            const Lanes met = block.least < value ? value : most;
            most = met > most ? met : most;
        }
        return std::max(most[0], most[1]);
    }

    /// Returns the total length of free space behind the plane over all rays, each limited to `reach`. Returns a
    /// partial sum once it reaches `enough`.
    [[nodiscard]] double freeSpaceBehind(double offset, double reach, double enough) const {
        const Lanes none = {};
        const Lanes endless = none + kInfinity;
        const Lanes most = none + reach;
        double sum = 0.0;
        for (std::size_t b = 0; b < blocks_ && sum < enough; ++b) {
            const Block& block = table_[b];
            const Lanes at_plane = (offset - block.at_start) / block.along;
            // The plane is hit from its free side, or from behind.
            const Lanes facing = block.free_end - (at_plane > 0.0 ? at_plane : none);
            const Lanes until = block.along > 0.0 ? at_plane : endless;
            const Lanes until_end = until < block.free_end ? until : block.free_end;
            const Lanes leaning = block.at_start > offset ? none : until_end;
            const Lanes length = block.along < 0.0 ? facing : leaning;
            const Lanes positive = length > 0.0 ? length : none;
            const Lanes counted = positive < most ? positive : most;
            for (std::size_t lane = 0; lane < std::min(kLanes, count_ - b * kLanes); ++lane) {
                sum += counted[lane];
            }
        }
        return sum;
    }

  private:
    struct Block {
        Lanes start[3];
        Lanes direction[3];
        Lanes least;  // lower bound of the support; +∞ for a ray without a hit
        Lanes first;
        Lanes free_end;
        Lanes along;
        Lanes at_start;
    };
    std::size_t count_;
    std::size_t blocks_;
    double u_max_;
    std::array<Block, (kFootprintRaysMax + kLanes - 1) / kLanes> table_;
};

/// The hits of a footprint whose rays are parallel and all hit a surface; a plane that faces the viewer depends only on
/// the hits. Most footprints are of this kind, and take a quarter of the time.
class PointTable {
  public:
    static bool holds(std::span<const FootprintRay> rays) {
        return std::ranges::all_of(rays, [&](const FootprintRay& ray) {
            return ray.u >= 0.0 && ray.direction == rays.front().direction;
        });
    }

    /// \param reach  limit of free space per ray, in u
    PointTable(std::span<const FootprintRay> rays, const glm::dvec3& origin, double reach)
        : blocks_((rays.size() + kLanes - 1) / kLanes) {
        assert(rays.size() <= kFootprintRaysMax);
        for (std::size_t i = 0; i < blocks_ * kLanes; ++i) {
            // A repeated point changes no maximum, and contributes 0 to sums.
            const FootprintRay& ray = rays[std::min(i, rays.size() - 1)];
            Block& block = table_[i / kLanes];
            const std::size_t lane = i % kLanes;
            const glm::dvec3 point = ray.origin + ray.u * ray.direction - origin;
            for (int axis = 0; axis < 3; ++axis) {
                block.point[axis][lane] = point[axis];
            }
            block.most[lane] = i < rays.size() ? std::min(ray.u, reach) : 0.0;
        }
    }

    /// RayTable::support() for a plane that faces the viewer.
    [[nodiscard]] double support(const glm::dvec3& n) {
        Lanes most = {-kInfinity, -kInfinity};
        for (std::size_t b = 0; b < blocks_; ++b) {
            Block& block = table_[b];
            block.at = n.x * block.point[0] + (n.y * block.point[1] + n.z * block.point[2]);
            most = block.at > most ? block.at : most;
        }
        return std::max(most[0], most[1]);
    }

    /// RayTable::freeSpaceBehind() for the normal of the last support().
    /// \param along  the component of the normal along the rays; negative
    [[nodiscard]] double freeSpaceBehind(double offset, double along) const {
        const double per_offset = -1.0 / along;
        const Lanes none = {};
        Lanes sum = none;
        for (std::size_t b = 0; b < blocks_; ++b) {
            const Block& block = table_[b];
            const Lanes length = (offset - block.at) * per_offset;
            const Lanes positive = length > 0.0 ? length : none;
            sum += positive < block.most ? positive : block.most;
        }
        return sum[0] + sum[1];
    }

  private:
    struct Block {
        Lanes point[3];  // hits, relative to the start of the centre ray
        Lanes most;      // limit of free space on the ray
        Lanes at;        // component along the current normal
    };
    std::size_t blocks_;
    std::array<Block, (kFootprintRaysMax + kLanes - 1) / kLanes> table_;
};

class PlaneSearch {
  public:
    PlaneSearch(std::span<const FootprintRay> rays, const AroundRays& around,
                std::span<const FootprintRay> edge, const FootprintRay& centre, const glm::dvec3& zero_depth,
                const PlaneFitOptions& options, DeepSolid* deep)
        : rays_(rays),
          around_(around),
          edge_(edge),
          centre_(centre),
          from_zero_(centre.origin - zero_depth),
          options_(options),
          deep_(deep),
          direction_length_(length(centre.direction)) {
        if (PointTable::holds(rays)) {
            points_.emplace(rays, centre.origin, options.reach);
        }
    }

    std::optional<FittedPlane> run() {
        glm::dvec3 sum(0.0);
        for (const FootprintRay& ray : rays_) {
            if (ray.u >= 0.0) {
                sum += ray.normal;
                ++hits_;
            }
        }
        if (hits_ == 0 && edge_.empty()) {
            return std::nullopt;
        }
        good_enough_ = options_.pixel_cost * static_cast<double>(rays_.size());
        const glm::dvec3 facing = -centre_.direction / direction_length_;
        if (hits_ == 0) {  // a surface enters the footprint between its rays
            return facingPlane(facing, edge_);
        }
        // Try the mean first: on a smooth surface nothing else is needed.
        const double sum_length = length(sum);
        tryCode(codeOf(sum_length > 1e-6 ? sum / sum_length : facing));
        if (best_cost_ > good_enough_ && trySupported()) {
            return best_;
        }
        const glm::dvec3* last = nullptr;
        for (const FootprintRay& ray : rays_) {
            const bool as_before = last != nullptr && *last == ray.normal;  // most rays hit the same triangle
            if (ray.u >= 0.0 && !as_before && best_cost_ > good_enough_) {
                tryCode(codeOf(ray.normal));
                last = &ray.normal;
            }
        }
        if (best_cost_ > good_enough_) {
            tryCode(codeOf(facing));
        }
        refine();
        return best_cost_ < kInfinity ? std::optional(best_) : facingPlane(facing, rays_);
    }

  private:
    /// Finds the best plane if all rays hit one surface and are nearly parallel. \return false: continue the search.
    bool trySupported() {
        if (options_.refinements == 0 || options_.inward_shift > 0.0 || options_.cautious ||
            hits_ < static_cast<int>(rays_.size())) {
            return false;
        }
        // Perpendicular to the ray, in units of its length.
        const glm::dvec3& ray = centre_.direction;
        const double square = direction_length_ * direction_length_;
        const glm::dvec3 x = anyAcross(ray);
        const glm::dvec3 y = cross(ray, x) / direction_length_;
        std::array<glm::dvec3, kFootprintRaysMax> points;
        glm::dvec3 mean(0.0);
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            const glm::dvec3 p = rays_[i].origin + rays_[i].u * rays_[i].direction - centre_.origin;
            points[i] = {dot(p, x) / square, dot(p, y) / square, dot(p, ray) / square};
            mean += points[i];
        }
        mean /= static_cast<double>(rays_.size());
        for (std::size_t i = 0; i < rays_.size(); ++i) {
            points[i] -= mean;
        }
        const std::optional<glm::dvec2> slope = highestBelow({points.data(), rays_.size()});
        if (!slope) {
            return false;
        }
        // The cross product of the tangents x + slope.x · ray and y + slope.y · ray.
        const glm::dvec3 normal = slope->x * x + slope->y * y - ray;
        const NormalIndex low = lowestAround(glm::vec3(unit(normal)));
        for (int i = 0; i < 4; ++i) {
            tryCode(packNormal(
                {static_cast<std::uint8_t>(low.s + i % 2), static_cast<std::uint8_t>(low.t + i / 2)}));
        }
        return best_cost_ < options_.reach * static_cast<double>(rays_.size()) / 8.0;
    }

    /// Returns a vector perpendicular to v, of the same length.
    static glm::dvec3 anyAcross(const glm::dvec3& v) {
        const bool along_x = std::abs(v.x) > 0.6 * length(v);
        const glm::dvec3 across = cross(v, along_x ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0));
        return across * std::sqrt(dot(v, v) / dot(across, across));
    }

    void refine() {
        for (int step = 1 << options_.refinements >> 1; step > 0 && best_cost_ > good_enough_; step /= 2) {
            forNeighbours(best_.index, step, [&](NormalIndex index) { tryCode(packNormal(index)); });
        }
    }

    void tryCode(std::uint16_t code) {
        const auto tried = std::span(tried_).first(std::min(tried_count_, tried_.size()));
        if (std::ranges::find(tried, code) != tried.end()) {
            return;
        }
        tried_[tried_count_++ % tried_.size()] = code;

        const glm::dvec3 normal(decodedNormals()[code]);
        const double along = dot(normal, centre_.direction);
        const double cosine = along / direction_length_;
        if (!(cosine <= -double{kPlaneCosineMin})) {
            return;
        }
        double offset = points_ ? points_->support(normal) : table(normal).support();
        if (cosine > -kSteepCosine) {
            offset = std::max(offset, supportOf(edge_, normal));
        }
        if (options_.cautious || cosine > -kDeepCosine) {
            offset = std::max(offset, supportOf(around(), normal));
        }
        if (options_.inward_shift > 0.0) {
            const double spread = offset - lowestOf(rays_, normal);
            offset -= spread < 0.25 * options_.span ? options_.inward_shift * spread : 0.0;
        }
        const double scaled = std::floor(offset / along / options_.u_max * kDepthCodes);
        if (!(scaled >= 0.0 && scaled <= kDepthCodes)) {
            return;
        }
        const double stored = scaled / kDepthCodes * options_.u_max * along;
        double cost = points_ ? points_->freeSpaceBehind(stored, along)
                              : table_->freeSpaceBehind(stored, options_.reach, best_cost_);
        if (options_.inward_shift > 0.0) {
            for (const FootprintRay& ray : rays_) {
                cost += solidInFront(ray, normal, stored);
            }
        }
        if (cost >= best_cost_) {
            return;
        }
        const bool justified =
            options_.starts_free && options_.inward_shift == 0.0 && -cosine > options_.rays_apart;
        if (!justified && isDeep(normal, stored)) {
            return;
        }
        best_cost_ = cost;
        best_ = {normal, unpackNormal(code), static_cast<std::uint16_t>(scaled)};
    }

    const RayTable& table(const glm::dvec3& normal) {
        if (!table_) {
            table_.emplace(rays_, centre_.origin, options_.u_max);
        }
        table_->setNormal(normal);
        return *table_;
    }

    std::span<const FootprintRay> around() {
        if (!around_traced_ && around_) {
            around_rays_ = around_();
        }
        around_traced_ = true;
        return around_rays_;
    }

    /// \param offset  of the plane from the start of the centre ray
    [[nodiscard]] bool isDeep(const glm::dvec3& normal, double offset) const {
        return deep_ != nullptr && deep_->cutBy(normal, offset + dot(normal, from_zero_));
    }

    [[nodiscard]] double lowestOf(std::span<const FootprintRay> rays, const glm::dvec3& normal) const {
        double offset = kInfinity;
        for (const FootprintRay& ray : rays) {
            if (ray.u >= 0.0) {
                offset = std::min(
                    offset, dot(normal, ray.origin - centre_.origin) + ray.u * dot(normal, ray.direction));
            }
        }
        return offset;
    }

    /// RayTable::support() for any rays.
    [[nodiscard]] double supportOf(std::span<const FootprintRay> rays, const glm::dvec3& normal) const {
        double offset = -kInfinity;
        for (const FootprintRay& ray : rays) {
            if (ray.u >= 0.0) {
                const double along = dot(normal, ray.direction);
                offset = std::max(offset, dot(normal, ray.origin - centre_.origin) +
                                              (along > 0.0 ? options_.u_max : ray.u) * along);
            }
        }
        return offset;
    }

    /// Returns the length of the solid part of a ray in front of the plane.
    [[nodiscard]] double solidInFront(const FootprintRay& ray, const glm::dvec3& normal,
                                      double offset) const {
        const double along = dot(normal, ray.direction);
        if (ray.u < 0.0 || !(along < 0.0)) {
            return 0.0;
        }
        const double at_plane = (offset - dot(normal, ray.origin - centre_.origin)) / along;
        return std::clamp(at_plane - ray.u, 0.0, options_.reach);
    }

    /// Fallback if every plane is too steep or outside the depth range: a plane at the nearest sample that faces the
    /// viewer. Returns nullopt if the result is unknown.
    std::optional<FittedPlane> facingPlane(const glm::dvec3& facing, std::span<const FootprintRay> rays) {
        double nearest = kInfinity;
        for (const FootprintRay& ray : rays) {
            if (ray.u >= 0.0) {
                const glm::dvec3 offset = ray.origin + ray.u * ray.direction - centre_.origin;
                nearest = std::min(nearest,
                                   dot(offset, centre_.direction) / (direction_length_ * direction_length_));
            }
        }
        const double scaled = std::floor(std::clamp(nearest / options_.u_max, 0.0, 1.0) * kDepthCodes);
        const std::uint16_t code = codeOf(facing);
        const FittedPlane plane{glm::dvec3(decodedNormals()[code]), unpackNormal(code),
                                static_cast<std::uint16_t>(scaled)};
        const double depth = plane.code / kDepthCodes * options_.u_max;
        if (!options_.starts_free && isDeep(plane.normal, depth * dot(plane.normal, centre_.direction))) {
            return std::nullopt;
        }
        return plane;
    }

    std::span<const FootprintRay> rays_;
    std::optional<PointTable> points_;
    std::optional<RayTable> table_;  // made on demand
    const AroundRays& around_;
    std::span<const FootprintRay> around_rays_;
    bool around_traced_ = false;
    std::span<const FootprintRay> edge_;
    const FootprintRay& centre_;
    glm::dvec3 from_zero_;
    const PlaneFitOptions& options_;
    DeepSolid* deep_;
    double direction_length_;
    int hits_ = 0;
    double good_enough_ = 0.0;
    double best_cost_ = kInfinity;
    FittedPlane best_;
    std::array<std::uint16_t, 48> tried_{};
    std::size_t tried_count_ = 0;
};

}  // namespace

std::optional<FittedPlane> fitSupportingPlane(std::span<const FootprintRay> rays, const AroundRays& around,
                                              std::span<const FootprintRay> edge, const FootprintRay& centre,
                                              const glm::dvec3& zero_depth, const PlaneFitOptions& options,
                                              DeepSolid* deep) {
    return PlaneSearch(rays, around, edge, centre, zero_depth, options, deep).run();
}

}  // namespace relief
