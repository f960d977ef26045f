#include "bake/fitted_map.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "bake/plane_fit.h"
#include "bake/triangle_plane.h"

namespace relief {
namespace {

/// Rays traced before their texels are fitted: bounds the memory for hits to 64 MiB whatever a map's size.
constexpr std::uint64_t kStripeRays = std::uint64_t{1} << 22;
constexpr double kDepthCodes = 65534.0;

/// Looks at one end of a view from where its rays start: u grows away from the viewer.
class EndView {
  public:
    EndView(const View& view, RayEnd end)
        : far_(end == RayEnd::kFar),
          u_max_(view.projection() == Projection::kCube ? double{kCubeDepthMax} : 1.0) {}

    [[nodiscard]] double uMax() const { return u_max_; }
    [[nodiscard]] FootprintRay fromViewer(const TexelRay& ray) const {
        return far_ ? FootprintRay{ray.origin + u_max_ * ray.direction, -ray.direction, -1.0, glm::dvec3(0.0)}
                    : FootprintRay{ray.origin, ray.direction, -1.0, glm::dvec3(0.0)};
    }
    [[nodiscard]] double uOf(double depth) const { return far_ ? u_max_ - depth : depth; }
    /// Map depth of a fitted plane. Exact in double: both count in the same 65534 parts.
    [[nodiscard]] double depthOf(const FittedPlane& plane) const {
        const double code = plane.u_code;
        return (far_ ? kDepthCodes - code : code) / kDepthCodes * u_max_;
    }
    /// Towards the viewer in map depth.
    [[nodiscard]] bool outwardsIsLess() const { return !far_; }

  private:
    bool far_;
    double u_max_;
};

/// The ring of texels that stays empty (depth_map.h).
bool isBorder(const View& view, std::uint32_t x, std::uint32_t y) {
    return view.projection() == Projection::kOrthographic &&
           (x == 0 || y == 0 || x + 1 == view.width || y + 1 == view.height);
}

/// A half-float depth on the viewer's side of `depth`.
float outwardHalf(double depth, bool outwards_is_less) {
    const std::uint16_t nearest = encodeHalfDepth(static_cast<float>(depth));
    const double decoded = decodeHalfDepth(nearest);
    if (outwards_is_less && decoded > depth) {
        return decodeHalfDepth(std::max<std::uint16_t>(nearest - 1, encodeHalfDepth(0.0F)));
    }
    if (!outwards_is_less && decoded < depth) {
        return decodeHalfDepth(std::min<std::uint16_t>(nearest + 1, encodeHalfDepth(1.0F)));
    }
    return static_cast<float>(decoded);
}

/// Fits the texels of one end, from the hits of a view with `samples` times as many texels each way.
class EndFitter {
  public:
    EndFitter(const RayScene& scene, const TriangleNormals& normals, const View& view, const View& fine,
              RayEnd end, const FittedMapOptions& options)
        : normals_(normals),
          view_(view),
          fine_(fine),
          end_(view, end),
          samples_(options.samples),
          inside_out_(scene.winding() < 0.0),
          starts_free_(view.starts_free[static_cast<std::size_t>(end)]) {
        // One unit of u in object units: the length of the depth axis, or of a cube's mean half side.
        const auto length = [](const glm::dvec3& v) { return std::sqrt(dot(v, v)); };
        const double unit = view.projection() == Projection::kCube
                                ? (length(view.axis[0]) + length(view.axis[1]) + length(view.axis[2])) / 3.0
                                : length(view.axis[2]);
        fit_.u_max = end_.uMax();
        fit_.reach = options.reach / unit;
        fit_.pixel_cost = options.good_enough / unit;
        fit_.refinements = options.refinements;
        rays_.resize(std::size_t{samples_} * samples_);
    }

    /// \param hits  of the fine view, from row `first_row` of the face on.
    std::optional<Surface> fit(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t first_row,
                               std::span<const Hit> hits) {
        bool any = false;
        for (std::uint32_t j = 0; j < samples_; ++j) {
            const std::uint32_t row = y * samples_ + j;
            for (std::uint32_t i = 0; i < samples_; ++i) {
                const std::uint32_t column = x * samples_ + i;
                any = any || !hits[std::size_t{row - first_row} * fine_.width + column].empty();
            }
        }
        if (!any) {
            return std::nullopt;
        }
        for (std::uint32_t j = 0; j < samples_; ++j) {
            const std::uint32_t row = y * samples_ + j;
            for (std::uint32_t i = 0; i < samples_; ++i) {
                const std::uint32_t column = x * samples_ + i;
                const Hit& hit = hits[std::size_t{row - first_row} * fine_.width + column];
                if (!hit.empty() && !starts_free_ && hit.fromBehind() != inside_out_) {
                    return std::nullopt;  // the ray starts inside: what lies before this surface is not free
                }
                FootprintRay& ray = rays_[std::size_t{j} * samples_ + i];
                ray = end_.fromViewer(fine_.ray(face, column, row));
                if (!hit.empty()) {
                    ray.u = end_.uOf(hit.depth());
                    const glm::dvec3& normal = normals_[hit.triangle()];
                    ray.normal = hit.fromBehind() ? -normal : normal;
                }
            }
        }
        const std::optional<FittedPlane> plane =
            fitSupportingPlane(rays_, end_.fromViewer(view_.ray(face, x, y)), fit_);
        if (!plane) {
            return std::nullopt;
        }
        const double depth = end_.depthOf(*plane);
        return Surface{view_.format == MapFormat::kFrontBackHalf ? outwardHalf(depth, end_.outwardsIsLess())
                                                                 : static_cast<float>(depth),
                       glm::vec3(plane->normal)};
    }

  private:
    const TriangleNormals& normals_;
    const View& view_;
    const View& fine_;
    EndView end_;
    std::uint32_t samples_;
    bool inside_out_;
    bool starts_free_;
    PlaneFitOptions fit_;
    std::vector<FootprintRay> rays_;
};

}  // namespace

TriangleNormals::TriangleNormals(const TriangleMesh& mesh) : normals_(mesh.triangles.size()) {
    tbb::parallel_for(std::size_t{0}, normals_.size(), [&](std::size_t i) {
        const glm::dvec3 n = planeOf(mesh, static_cast<std::uint32_t>(i)).normal;
        normals_[i] = n / std::sqrt(dot(n, n));
    });
}

DepthMap bakeFittedMap(const RayScene& scene, const TriangleNormals& normals, const View& view,
                       const FittedMapOptions& options, std::uint64_t& covered,
                       const std::function<void(std::uint32_t)>& rowsDone) {
    View fine = view;
    fine.width *= options.samples;
    fine.height *= options.samples;

    DepthMap map = view.emptyMap();
    map.decode = Decode::kPlane;
    const auto stripe_rows = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
        kStripeRays / (std::uint64_t{fine.width} * options.samples), 1, view.height));
    std::array<std::vector<Hit>, 2> hits;
    covered = 0;
    for (std::uint32_t face = 0; face < view.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < view.height; y += stripe_rows) {
            const std::uint32_t y_end = std::min(y + stripe_rows, view.height);
            const RowRange rows{face, y * options.samples, y_end * options.samples};
            for (const RayEnd end : {RayEnd::kNear, RayEnd::kFar}) {
                if (view.keeps(end)) {
                    std::vector<Hit>& end_hits = hits[static_cast<std::size_t>(end)];
                    end_hits.resize(std::size_t{rows.end - rows.begin} * fine.width);
                    scene.trace(fine, end, rows, end_hits);
                }
            }
            const auto fitRows = [&](const tbb::blocked_range<std::uint32_t>& block, std::uint64_t count) {
                EndFitter near_fitter(scene, normals, view, fine, RayEnd::kNear, options);
                EndFitter far_fitter(scene, normals, view, fine, RayEnd::kFar, options);
                for (std::uint32_t row = block.begin(); row != block.end(); ++row) {
                    for (std::uint32_t x = 0; x < view.width; ++x) {
                        Texel texel;
                        if (isBorder(view, x, row)) {
                            encodeTexel(map.format, texel, map.texelAt(face, x, row));
                            continue;
                        }
                        if (view.keeps(RayEnd::kNear)) {
                            texel.front = near_fitter.fit(face, x, row, rows.begin, hits[0]);
                        }
                        if (view.keeps(RayEnd::kFar)) {
                            texel.back = far_fitter.fit(face, x, row, rows.begin, hits[1]);
                        }
                        if (view.compare == Compare::kGreater) {
                            texel.front.swap(texel.back);  // a map of one surface holds it as its front
                        }
                        encodeTexel(map.format, texel, map.texelAt(face, x, row));
                        count += texel.front || texel.back ? 1U : 0U;
                    }
                }
                return count;
            };
            covered += tbb::parallel_reduce(tbb::blocked_range<std::uint32_t>(y, y_end), std::uint64_t{0},
                                            fitRows, std::plus<>());
            rowsDone(y_end - y);
        }
    }
    return map;
}

}  // namespace relief
