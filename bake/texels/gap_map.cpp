// SPDX-License-Identifier: Apache-2.0
#include "bake/texels/gap_map.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "bake/texels/fitted_end.h"
#include "bake/texels/plane_fit.h"
#include "formats/texel.h"

namespace relief {
namespace {

/// Parts of a gap whose middles are looked up in the earlier maps.
constexpr int kParts = 4;
/// The least weight of a gap, in units of the mesh's longest side.
constexpr double kShortest = 1e-3;
/// Least |cosine| of a plane with the ray: a steeper one would reach far into the solid beyond the end of the gap.
constexpr double kSteepest = 0.1;
/// More than this share of a texel's rays must be free in the middle of the gap: a wall along the line of sight, which no
/// plane of the texel spares, may be as thin as a texel. Sheets are twice as thick (defaultThickness).
constexpr double kFreeShare = 0.5;
constexpr double kCautiousShare = 0.99;
/// Rows between two calls of the progress function.
constexpr std::uint32_t kStripeRows = 64;

/// In object units.
double lengthOf(const LineGap& gap, const glm::dvec3& direction) {
    return gap.length() * length(direction);
}

/// Fits single texels. Not thread-safe.
class GapFitter {
  public:
    GapFitter(const MeshQuery& query, const TriangleNormals& normals, const View& view, const View& fine,
              const FittedMapOptions& options, const IsKnown& is_known)
        : query_(query),
          normals_(normals),
          view_(view),
          fine_(fine),
          samples_(options.samples),
          is_known_(is_known),
          winding_(query.prepared().orientation() < 0.0 ? -1.0 : 1.0),
          shortest_(kShortest * query.mesh().bounds.longestSide()),
          share_(options.cautious ? kCautiousShare : kFreeShare),
          ends_{EndView(view, RayEnd::kNear), EndView(view, RayEnd::kFar)},
          fit_(fitOptions(view, options)) {
        fit_.steepest = kSteepest;
    }

    [[nodiscard]] Texel fit(std::uint32_t x, std::uint32_t y) {
        const TexelRay centre = view_.ray(0, x, y);
        const std::optional<LineGap> gap = bestGap(centre);
        Texel texel;
        if (!gap || !look(x, y, centre, *gap)) {
            return texel;
        }
        for (std::size_t end = 0; end < 2; ++end) {
            const std::optional<FittedPlane> plane = fitSupportingPlane(
                rays_[end], nullptr, {}, ends_[end].fromViewer(centre), centre.origin, fit_);
            if (!plane) {
                return {};
            }
            (end == 0 ? texel.front : texel.back) = ends_[end].surfaceOf(*plane, view_.format);
        }
        return texel;
    }

  private:
    /// The gap of the greatest weight.
    [[nodiscard]] std::optional<LineGap> bestGap(const TexelRay& ray) const {
        std::vector<LineGap> gaps = query_.gapsAlong(ray.origin, ray.direction);
        for (LineGap& gap : gaps) {
            gap.begin = std::max(gap.begin, 0.0);
            gap.end = std::min(gap.end, 1.0);
        }
        // No weight exceeds the length: with the longest first, few are looked up. Of equals the first on the ray.
        std::ranges::stable_sort(gaps, std::greater<>(), &LineGap::length);
        std::optional<LineGap> best;
        double most = shortest_;
        for (const LineGap& gap : gaps) {
            const double longest = lengthOf(gap, ray.direction);
            if (!(longest > shortest_) || longest < most) {
                break;
            }
            const double weight = unknownParts(gap, ray.origin, ray.direction, kParts,
                                               [&](const glm::dvec3& p) { return is_known_(glm::vec3(p)); }) *
                                  longest / kParts;
            const bool better = weight > most || (best && weight == most && gap.begin < best->begin);
            if (better && !query_.inside(glm::vec3(ray.at(gap.middle())))) {
                most = weight;
                best = gap;
            }
        }
        return best;
    }

    /// The depth of the gap's middle at an offset across the texel, along the mean of the planes at its ends.
    [[nodiscard]] double middleBeside(const LineGap& gap, const TexelRay& centre,
                                      const glm::dvec3& offset) const {
        double moved = 0.0;
        for (const std::uint32_t triangle : {gap.first, gap.last}) {
            const glm::dvec3& normal = normals_[triangle];
            const double along = dot(normal, centre.direction);
            if (std::abs(along) > kSteepest * length(centre.direction)) {
                moved -= 0.5 * dot(normal, offset) / along;
            }
        }
        return gap.middle() + moved;
    }

    /// Traces the texel's rays from the middle of the gap. \return false if too few of them are free there.
    bool look(std::uint32_t x, std::uint32_t y, const TexelRay& centre, const LineGap& gap) {
        rays_[0].clear();
        rays_[1].clear();
        const double least = share_ * samples_ * samples_;
        const std::uint32_t count = samples_ * samples_;
        for (std::uint32_t k = 0; k < count; ++k) {
            if (!(static_cast<double>(rays_[0].size() + (count - k)) > least)) {
                return false;  // whatever the others
            }
            const TexelRay along = fine_.ray(0, x * samples_ + k % samples_, y * samples_ + k / samples_);
            for (const double middle :
                 {middleBeside(gap, centre, along.origin - centre.origin), gap.middle()}) {
                const std::optional<FootprintRay> ahead = lookOneWay(along, middle, 0);
                const std::optional<FootprintRay> back = ahead ? lookOneWay(along, middle, 1) : std::nullopt;
                if (back) {
                    rays_[0].push_back(*ahead);
                    rays_[1].push_back(*back);
                    break;
                }
            }
        }
        return static_cast<double>(rays_[0].size()) > least;
    }

    [[nodiscard]] std::optional<FootprintRay> lookOneWay(const TexelRay& along, double middle,
                                                         std::size_t end) const {
        const double sign = end == 0 ? 1.0 : -1.0;
        if (!(middle > 0.0 && middle < 1.0)) {
            return std::nullopt;
        }
        const auto hit = query_.firstHit(along.at(middle), sign * along.direction);
        if (!hit) {
            return std::nullopt;  // past an edge of the mesh: not a gap
        }
        const glm::dvec3& normal = normals_[hit->triangle];
        if (sign * winding_ * dot(normal, along.direction) > 0.0) {
            return std::nullopt;  // from within a solid
        }
        FootprintRay ray = ends_[end].fromViewer(along);
        ray.u = ends_[end].uOf(std::clamp(middle + sign * hit->along, 0.0, 1.0));
        ray.u_last = 1.0;
        ray.normal = winding_ * normal;
        return ray;
    }

    const MeshQuery& query_;
    const TriangleNormals& normals_;
    const View& view_;
    const View& fine_;
    std::uint32_t samples_;
    const IsKnown& is_known_;
    double winding_;
    double shortest_;
    double share_;
    EndView ends_[2];
    PlaneFitOptions fit_;
    std::array<std::vector<FootprintRay>, 2> rays_;  // by RayEnd
};

}  // namespace

DepthMap bakeGapMap(const MeshQuery& query, const TriangleNormals& normals, const View& view,
                    const FittedMapOptions& options, const IsKnown& is_known, std::uint64_t& covered,
                    const std::function<void(std::uint32_t)>& rowsDone) {
    const View fine = view.scaled(options.samples);
    DepthMap map = view.emptyMap();
    map.decode = Decode::kPlane;
    covered = 0;
    for (std::uint32_t begin = 0; begin < view.height; begin += kStripeRows) {
        const std::uint32_t end = std::min(begin + kStripeRows, view.height);
        covered += tbb::parallel_reduce(
            tbb::blocked_range<std::uint32_t>(begin, end), std::uint64_t{0},
            [&](const auto& rows, std::uint64_t count) {
                GapFitter fitter(query, normals, view, fine, options, is_known);
                for (std::uint32_t y = rows.begin(); y != rows.end(); ++y) {
                    for (std::uint32_t x = 0; x < view.width; ++x) {
                        const Texel texel = isBorder(view, x, y) ? Texel{} : fitter.fit(x, y);
                        encodeTexel(map.format, texel, map.texelAt(0, x, y));
                        count += texel.front ? 1U : 0U;
                    }
                }
                return count;
            },
            std::plus<>());
        rowsDone(end - begin);
    }
    return map;
}

}  // namespace relief
