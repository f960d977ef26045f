#include "bake/plane_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bake/triangle_plane.h"

namespace relief {
namespace {

constexpr double kDepthCodes = 65534.0;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Cosine between the normal and the centre ray below which a plane is not stored: its depth there would be
/// ill-defined, and an error of the quantised normal moves it far.
constexpr double kGrazingMin = 1.0 / 32.0;

/// The decoded vectors of all indices, in double: candidates are looked up thousands of times a texel row.
const std::array<glm::dvec3, 65536>& normalTable() {
    static const auto* const table = [] {
        auto* t = new std::array<glm::dvec3, 65536>;
        for (std::size_t code = 0; code < t->size(); ++code) {
            (*t)[code] = glm::dvec3(decodeNormal(unpackNormal(static_cast<std::uint16_t>(code))));
        }
        return t;
    }();
    return *table;
}

std::uint16_t codeOf(const glm::dvec3& normal) {
    return packNormal(encodeNormal(glm::vec3(normal)));
}

/// The search for one texel's plane.
class PlaneSearch {
  public:
    PlaneSearch(std::span<const FootprintRay> rays, const FootprintRay& centre,
                const PlaneFitOptions& options)
        : rays_(rays),
          centre_(centre),
          options_(options),
          direction_length_(std::sqrt(dot(centre.direction, centre.direction))) {}

    std::optional<FittedPlane> run() {
        glm::dvec3 sum(0.0);
        for (const FootprintRay& ray : rays_) {
            if (ray.u >= 0.0) {
                sum += ray.normal;
                ++hits_;
            }
        }
        if (hits_ == 0) {
            return std::nullopt;
        }
        good_enough_ = options_.pixel_cost * static_cast<double>(rays_.size());
        const glm::dvec3 facing = -centre_.direction / direction_length_;
        // The mean first: on a smooth surface nothing else is needed.
        const double sum_length = std::sqrt(dot(sum, sum));
        tryCode(codeOf(sum_length > 1e-6 ? sum / sum_length : facing));
        for (const FootprintRay& ray : rays_) {
            if (ray.u >= 0.0 && best_cost_ > good_enough_) {
                tryCode(codeOf(ray.normal));
            }
        }
        if (best_cost_ > good_enough_) {
            tryCode(codeOf(facing));
        }
        for (int step = 1 << options_.refinements >> 1; step > 0 && best_cost_ > good_enough_; step /= 2) {
            tryNeighbours(step);
        }
        if (best_cost_ == kInfinity) {
            takeFacing(facing);
        }
        return best_;
    }

  private:
    void tryNeighbours(int step) {
        const NormalIndex from = best_.index;
        for (int dt = -step; dt <= step; dt += step) {
            for (int ds = -step; ds <= step; ds += step) {
                const int s = from.s + ds;
                const int t = from.t + dt;
                if (s >= 0 && s <= 254 && t >= 0 && t <= 254) {
                    tryCode(packNormal({static_cast<std::uint8_t>(s), static_cast<std::uint8_t>(t)}));
                }
            }
        }
    }

    void tryCode(std::uint16_t code) {
        const std::size_t seen_end = std::min(tried_count_, tried_.size());
        for (std::size_t i = 0; i < seen_end; ++i) {
            if (tried_[i] == code) {
                return;
            }
        }
        tried_[tried_count_++ % tried_.size()] = code;

        const glm::dvec3& normal = normalTable()[code];
        const double along = dot(normal, centre_.direction);
        if (!(along <= -kGrazingMin * direction_length_)) {
            return;
        }
        // Pushed until no sampled surface point lies in front.
        double offset = -kInfinity;
        for (const FootprintRay& ray : rays_) {
            if (ray.u >= 0.0) {
                offset = std::max(
                    offset, dot(normal, ray.origin - centre_.origin) + ray.u * dot(normal, ray.direction));
            }
        }
        const double scaled = std::floor(offset / along / options_.u_max * kDepthCodes);
        if (!(scaled >= 0.0 && scaled <= kDepthCodes)) {
            return;
        }
        const double stored = scaled / kDepthCodes * options_.u_max * along;
        double cost = 0.0;
        for (const FootprintRay& ray : rays_) {
            cost += freeSpaceBehind(ray, normal, stored);
            if (cost >= best_cost_) {
                return;
            }
        }
        best_cost_ = cost;
        best_ = {normal, unpackNormal(code), static_cast<std::uint16_t>(scaled)};
    }

    /// Length of the part of a ray that is free but behind the plane, at most `reach`.
    [[nodiscard]] double freeSpaceBehind(const FootprintRay& ray, const glm::dvec3& normal,
                                         double offset) const {
        const double along = dot(normal, ray.direction);
        const double start = dot(normal, ray.origin - centre_.origin);
        if (!(along < 0.0)) {  // the ray runs beside the plane, or away from it
            return start > offset ? 0.0 : options_.reach;
        }
        const double at_plane = (offset - start) / along;
        return ray.u >= 0.0 ? std::clamp(ray.u - at_plane, 0.0, options_.reach) : options_.reach;
    }

    /// The last resort, where every plane leaves the depth range: facing the viewer, at the nearest sample.
    void takeFacing(const glm::dvec3& facing) {
        double nearest = kInfinity;
        for (const FootprintRay& ray : rays_) {
            if (ray.u >= 0.0) {
                const glm::dvec3 offset = ray.origin + ray.u * ray.direction - centre_.origin;
                nearest = std::min(nearest,
                                   dot(offset, centre_.direction) / (direction_length_ * direction_length_));
            }
        }
        const double scaled = std::floor(std::clamp(nearest / options_.u_max, 0.0, 1.0) * kDepthCodes);
        const std::uint16_t code = codeOf(facing);
        best_ = {normalTable()[code], unpackNormal(code), static_cast<std::uint16_t>(scaled)};
    }

    std::span<const FootprintRay> rays_;
    const FootprintRay& centre_;
    const PlaneFitOptions& options_;
    double direction_length_;
    int hits_ = 0;
    double good_enough_ = 0.0;
    double best_cost_ = kInfinity;
    FittedPlane best_;
    std::array<std::uint16_t, 48> tried_{};
    std::size_t tried_count_ = 0;
};

}  // namespace

std::optional<FittedPlane> fitSupportingPlane(std::span<const FootprintRay> rays, const FootprintRay& centre,
                                              const PlaneFitOptions& options) {
    return PlaneSearch(rays, centre, options).run();
}

}  // namespace relief
