#include "bake/texels/raycast.h"

#include <embree3/rtcore.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bake/mesh/embree_mesh.h"
#include "bake/mesh/mesh_edges.h"
#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

constexpr std::uint32_t kTile = 4;  // a packet is 4×4 texels
constexpr int kLanes = 16;
/// A hit this near to an edge, in barycentric coordinates, may as well be the neighbour's.
constexpr float kEdgeWidth = 1e-4F;
/// Surfaces this near along the ray, in units of its length, meet at an edge.
constexpr float kTieDepth = 1e-5F;
/// A ray this much deeper, in map depth, than those beside it may have slipped through.
constexpr float kDepthJump = 0.08F;
/// How far beside a ray that may have slipped through others look, and how near to it a triangle must come to
/// count as met. Embree's units: the mesh is one to two long. Floats there are 6e-8 apart.
constexpr double kBeside = 0x1p-17;
constexpr double kTouching = 1e-6;
constexpr int kBesideRays = 8;
constexpr std::size_t kPlaneDepths = 256;
constexpr std::uint32_t kNone = 0xffffffff;

/// Sines and cosines of the places round a ray where lookAgain looks: the first two on either side, none
/// along an edge of a grid.
constexpr std::array<std::array<double, 2>, kBesideRays> kBesideDirections = {{{0.1951, 0.9808},
                                                                               {-0.2588, -0.9659},
                                                                               {0.9877, -0.1564},
                                                                               {0.6018, -0.7986},
                                                                               {0.8090, 0.5878},
                                                                               {-0.7660, -0.6428},
                                                                               {-0.9945, 0.1045},
                                                                               {-0.6428, 0.7660}}};

/// Collects the triangles that one ray meets, and lets it pass through them.
struct Collector {
    RTCIntersectContext context{};
    std::vector<std::uint32_t> triangles;

    static void filter(const RTCFilterFunctionNArguments* args) {
        // RTCIntersectContext is the first member: Embree hands back the pointer it was given.
        auto* self = reinterpret_cast<Collector*>(args->context);
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] != 0) {
                self->triangles.push_back(RTCHitN_primID(args->hit, args->N, i));
                args->valid[i] = 0;
            }
        }
    }
};

}  // namespace

struct RayScene::Impl {
    const TriangleMesh* mesh = nullptr;
    EmbreeMesh tree;
    double winding = 1.0;
    bool closed = false;  // no odd edges

    class Tracer;
};

/// Traces the packets of one row of tiles.
class RayScene::Impl::Tracer {
  public:
    Tracer(const Impl& impl, const View& view, RayEnd end)
        : impl_(impl), view_(view), end_(end), inside_out_(impl.winding < 0.0) {
        rtcInitIntersectContext(&context_);
        context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        for (int lane = 0; lane < kLanes; ++lane) {
            packet_.ray.mask[lane] = 0xffffffff;
            packet_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        if (view.projection() == Projection::kOrthographic) {
            prepareOrthographic();
        }
    }

    /// \param hits  rows of the view from y0 on.
    void traceTileRow(std::uint32_t face, std::uint32_t y0, std::uint32_t y_end, Hit* hits) {
        const std::uint32_t rows = std::min(kTile, y_end - y0);
        for (std::uint32_t x0 = 0; x0 < view_.width; x0 += kTile) {
            const std::uint32_t columns = std::min(kTile, view_.width - x0);
            setValid(columns, rows);
            if (view_.projection() == Projection::kOrthographic) {
                setOrthographicRays(x0, y0);
            } else {
                setCubeRays(face, x0, y0);
            }
            rtcIntersect16(valid_, impl_.tree.scene.get(), &context_, &packet_);
            prefetchCorners();
            // What mendPinholes goes by: most tiles need no second look.
            float low = std::numeric_limits<float>::max();
            float high = -low;
            std::uint32_t outer = 0;
            for (std::uint32_t row = 0; row < rows; ++row) {
                Hit* const out = hits + std::size_t{row} * view_.width + x0;
                for (std::uint32_t column = 0; column < columns; ++column) {
                    const std::size_t lane = row * kTile + column;
                    if (packet_.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
                        out[column] = Hit();
                        continue;
                    }
                    const Hit hit = resolve(face, x0 + column, y0 + row, lane);
                    low = std::min(low, hit.depth());
                    high = std::max(high, hit.depth());
                    outer += metInside(hit) ? 0U : 1U;
                    out[column] = hit;
                }
            }
            if (outer != 0 && (outer != rows * columns || high - low >= kDepthJump)) {
                mendPinholes(face, x0, y0, columns, rows, hits);
            }
        }
    }

    Hit traceOne(std::uint32_t face, std::uint32_t x, std::uint32_t y) {
        const TexelRay ray = view_.ray(face, x, y);
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query = queryOf(segmentOf(ray));
        rtcIntersect1(impl_.tree.scene.get(), &context, &query);
        if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
            return {};
        }
        const Hit hit = view_.projection() == Projection::kOrthographic
                            ? orthographicHit(x, y, query.hit.primID)
                            : cubeHit(ray, query.hit.primID);
        // Alone, a ray is doubted only where no ray from free space may get: at the inner side of a closed
        // mesh.
        return impl_.closed && metInside(hit) ? lookAgain(face, x, y, hit) : hit;
    }

  private:
    static std::uint32_t columnOf(int lane) { return static_cast<std::uint32_t>(lane) % kTile; }
    static std::uint32_t rowOf(int lane) { return static_cast<std::uint32_t>(lane) / kTile; }

    /// Which lanes carry a ray: all but at the view's edges.
    void setValid(std::uint32_t columns, std::uint32_t rows) {
        if (columns != valid_columns_ || rows != valid_rows_) {
            valid_columns_ = columns;
            valid_rows_ = rows;
            for (int lane = 0; lane < kLanes; ++lane) {
                valid_[lane] = columnOf(lane) < columns && rowOf(lane) < rows ? -1 : 0;
            }
        }
    }

    /// Asks for the corners of all triangles met before the first of them is needed: half the time of
    /// resolving hits was waiting for them, one after the other. Inlined by force: GCC takes a function that
    /// only prefetches for one without effect, and leaves its calls out.
    [[gnu::always_inline]] void prefetchCorners() const {
        const glm::uvec3* const triangles = impl_.mesh->triangles.data();
        const glm::vec3* const positions = impl_.mesh->positions.data();
        for (int lane = 0; lane < kLanes; ++lane) {
            if (packet_.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
                __builtin_prefetch(triangles + packet_.hit.primID[lane]);
            }
        }
        for (int lane = 0; lane < kLanes; ++lane) {
            if (packet_.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID) {
                const glm::uvec3& triangle = triangles[packet_.hit.primID[lane]];
                __builtin_prefetch(positions + triangle.x);
                __builtin_prefetch(positions + triangle.z);
            }
        }
    }

    /// A ray as it is traced: from a little outside the volume, along or against the depth.
    struct Segment {
        glm::dvec3 origin;
        glm::dvec3 direction;
        double length;  ///< of the parameter
    };
    [[nodiscard]] Segment segmentOf(const TexelRay& ray) const {
        const double depth_max = view_.depthMax(ray);
        // A cube's rays start in its very centre.
        const bool from_point = view_.projection() == Projection::kCube && end_ == RayEnd::kNear;
        const double slack = from_point ? 0.0 : kDepthSlack;
        if (end_ == RayEnd::kNear) {
            return {ray.origin - slack * ray.direction, ray.direction, depth_max + 2.0 * slack};
        }
        const double back = view_.projection() == Projection::kCube ? 0.0 : slack;
        return {ray.origin + (depth_max + slack) * ray.direction, -ray.direction, depth_max + slack + back};
    }

    void prepareOrthographic() {
        first_ray_ = view_.ray(0, 0, 0);
        column_step_ = view_.axis[0] / static_cast<double>(view_.width);
        row_step_ = view_.axis[1] / static_cast<double>(view_.height);
        const Segment segment = segmentOf(first_ray_);
        local_origin_ = (segment.origin - impl_.tree.center) * impl_.tree.scale;
        local_column_step_ = column_step_ * impl_.tree.scale;
        local_row_step_ = row_step_ * impl_.tree.scale;
        const glm::vec3 direction = segment.direction * impl_.tree.scale;
        for (int lane = 0; lane < kLanes; ++lane) {
            const glm::vec3 offset = static_cast<double>(columnOf(lane)) * local_column_step_ +
                                     static_cast<double>(rowOf(lane)) * local_row_step_;
            offset_x_[lane] = offset.x;
            offset_y_[lane] = offset.y;
            offset_z_[lane] = offset.z;
            packet_.ray.dir_x[lane] = direction.x;
            packet_.ray.dir_y[lane] = direction.y;
            packet_.ray.dir_z[lane] = direction.z;
        }
        length_ = static_cast<float>(segment.length);
    }

    void setOrthographicRays(std::uint32_t x0, std::uint32_t y0) {
        const glm::vec3 corner = local_origin_ + (static_cast<double>(x0) * local_column_step_ +
                                                  static_cast<double>(y0) * local_row_step_);
        for (int lane = 0; lane < kLanes; ++lane) {
            packet_.ray.org_x[lane] = corner.x + offset_x_[lane];
            packet_.ray.org_y[lane] = corner.y + offset_y_[lane];
            packet_.ray.org_z[lane] = corner.z + offset_z_[lane];
            packet_.ray.tfar[lane] = length_;
            packet_.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    void setCubeRays(std::uint32_t face, std::uint32_t x0, std::uint32_t y0) {
        for (int lane = 0; lane < kLanes; ++lane) {
            const Segment segment = segmentOf(view_.ray(face, x0 + columnOf(lane), y0 + rowOf(lane)));
            const glm::vec3 origin = impl_.tree.toLocal(segment.origin);
            const glm::vec3 direction = segment.direction * impl_.tree.scale;
            packet_.ray.org_x[lane] = origin.x;
            packet_.ray.org_y[lane] = origin.y;
            packet_.ray.org_z[lane] = origin.z;
            packet_.ray.dir_x[lane] = direction.x;
            packet_.ray.dir_y[lane] = direction.y;
            packet_.ray.dir_z[lane] = direction.z;
            packet_.ray.tfar[lane] = static_cast<float>(segment.length);
            packet_.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
    }

    Hit resolve(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::size_t lane) {
        std::uint32_t triangle = packet_.hit.primID[lane];
        const float u = packet_.hit.u[lane];
        const float v = packet_.hit.v[lane];
        if (std::min({u, v, 1.0F - u - v}) < kEdgeWidth) {
            triangle = bestAtEdge(segmentOf(view_.ray(face, x, y)), packet_.ray.tfar[lane], triangle);
        }
        return view_.projection() == Projection::kOrthographic ? orthographicHit(x, y, triangle)
                                                               : cubeHit(view_.ray(face, x, y), triangle);
    }

    // --- pinholes: robust or not, Embree lets some rays that are aimed exactly at a vertex or edge pass ---

    /// The ray met the side that a closed mesh turns inwards.
    [[nodiscard]] bool metInside(const Hit& hit) const { return hit.fromBehind() != inside_out_; }

    /// Looks again at the rays of a tile that met nothing, an inner side, or something far behind, although
    /// those beside them met an outer side.
    void mendPinholes(std::uint32_t face, std::uint32_t x0, std::uint32_t y0, std::uint32_t columns,
                      std::uint32_t rows, Hit* hits) {
        const auto at = [&](std::uint32_t column, std::uint32_t row) -> Hit& {
            return hits[std::size_t{row} * view_.width + x0 + column];
        };
        // All are judged by what was traced, not by what was mended before them.
        std::uint32_t doubtful = 0;
        for (std::uint32_t row = 0; row < rows; ++row) {
            for (std::uint32_t column = 0; column < columns; ++column) {
                const Hit& hit = at(column, row);
                std::uint32_t beside = 0;
                std::uint32_t before = 0;
                const auto compare = [&](const Hit& other) {
                    ++beside;
                    const float gap =
                        end_ == RayEnd::kNear ? hit.depth() - other.depth() : other.depth() - hit.depth();
                    before += !other.empty() && !metInside(other) &&
                                      (hit.empty() || metInside(hit) || gap > kDepthJump)
                                  ? 1U
                                  : 0U;
                };
                if (column > 0) {
                    compare(at(column - 1, row));
                }
                if (column + 1 < columns) {
                    compare(at(column + 1, row));
                }
                if (row > 0) {
                    compare(at(column, row - 1));
                }
                if (row + 1 < rows) {
                    compare(at(column, row + 1));
                }
                if (before > 0 && before >= std::min(beside, 3U)) {
                    doubtful |= 1U << (row * kTile + column);
                }
            }
        }
        for (std::uint32_t lane = 0; doubtful != 0; ++lane, doubtful >>= 1U) {
            if ((doubtful & 1U) != 0) {
                Hit& hit = at(lane % kTile, lane / kTile);
                hit = lookAgain(face, x0 + lane % kTile, y0 + lane / kTile, hit);
            }
        }
    }

    /// By rays beside the ray: what they meet before `hit` counts if the ray itself touches it.
    Hit lookAgain(std::uint32_t face, std::uint32_t x, std::uint32_t y, const Hit& hit) {
        const TexelRay ray = view_.ray(face, x, y);
        const Segment segment = segmentOf(ray);
        const glm::dvec3 direction = segment.direction * impl_.tree.scale;
        const double length = std::sqrt(dot(direction, direction));
        const glm::dvec3 unit = direction / length;
        const glm::dvec3 other = std::abs(unit.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        glm::dvec3 right = cross(unit, other);
        right = right / std::sqrt(dot(right, right));
        const glm::dvec3 up = cross(right, unit);

        // Of what is touched, the nearest, and all that lies as near: where edges meet.
        std::array<std::uint32_t, kBesideRays> touched{};
        std::array<float, kBesideRays> where{};
        std::size_t count = 0;
        float nearest = std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < kBesideDirections.size(); ++i) {
            if (i == 2 && count == 0) {
                return hit;  // beside a silhouette: as good as all that is doubted
            }
            const auto& [sine, cosine] = kBesideDirections[i];
            RTCIntersectContext context;
            rtcInitIntersectContext(&context);
            Segment shifted = segment;
            shifted.origin += (kBeside / impl_.tree.scale) * (cosine * right + sine * up);
            RTCRayHit query = queryOf(shifted);
            rtcIntersect1(impl_.tree.scene.get(), &context, &query);
            if (query.hit.geomID != RTC_INVALID_GEOMETRY_ID &&
                touches((segment.origin - impl_.tree.center) * impl_.tree.scale, right, up,
                        query.hit.primID)) {
                touched[count] = query.hit.primID;
                where[count++] = query.ray.tfar;
                nearest = std::min(nearest, query.ray.tfar);
            }
        }
        if (count == 0) {
            return hit;
        }
        // Triangles beside the ray lie a little before or behind where it meets them.
        const float tie = static_cast<float>(64.0 * kBeside / length);
        collector_.triangles.clear();
        for (std::size_t i = 0; i < count; ++i) {
            if (where[i] <= nearest + tie) {
                collector_.triangles.push_back(touched[i]);
            }
        }
        const std::uint32_t best = bestFacing(segment, collector_.triangles.front());
        const Hit found = view_.projection() == Projection::kOrthographic ? orthographicHit(x, y, best)
                                                                          : cubeHit(ray, best);
        const bool before = hit.empty() || (end_ == RayEnd::kNear ? found.depth() < hit.depth()
                                                                  : found.depth() > hit.depth());
        return before ? found : hit;
    }

    /// Whether a line through `origin`, square to `right` and `up`, passes a triangle within kTouching.
    [[nodiscard]] bool touches(const glm::dvec3& origin, const glm::dvec3& right, const glm::dvec3& up,
                               std::uint32_t triangle) const {
        const glm::uvec3& t = impl_.mesh->triangles[triangle];
        double x[3];
        double y[3];
        for (int i = 0; i < 3; ++i) {
            const glm::dvec3 p =
                (glm::dvec3(impl_.mesh->positions[t[i]]) - impl_.tree.center) * impl_.tree.scale - origin;
            x[i] = dot(p, right);
            y[i] = dot(p, up);
        }
        int sides = 0;
        double closest = std::numeric_limits<double>::max();
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const double ex = x[j] - x[i];
            const double ey = y[j] - y[i];
            const double side = ex * y[i] - ey * x[i];
            sides += side > 0.0 ? 1 : side < 0.0 ? -1 : 0;
            const double square = ex * ex + ey * ey;
            const double along = square > 0.0 ? std::clamp(-(x[i] * ex + y[i] * ey) / square, 0.0, 1.0) : 0.0;
            const double dx = x[i] + along * ex;
            const double dy = y[i] + along * ey;
            closest = std::min(closest, std::sqrt(dx * dx + dy * dy));
        }
        return std::abs(sides) == 3 || closest <= kTouching;
    }

    [[nodiscard]] RTCRayHit queryOf(const Segment& segment) const {
        const glm::vec3 origin = impl_.tree.toLocal(segment.origin);
        const glm::vec3 direction = segment.direction * impl_.tree.scale;
        RTCRayHit query{};
        query.ray.org_x = origin.x;
        query.ray.org_y = origin.y;
        query.ray.org_z = origin.z;
        query.ray.dir_x = direction.x;
        query.ray.dir_y = direction.y;
        query.ray.dir_z = direction.z;
        query.ray.tfar = static_cast<float>(segment.length);
        query.ray.mask = 0xffffffff;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        return query;
    }

    /// Of the triangles that the ray meets about `at`, the one that the contract of trace() names.
    std::uint32_t bestAtEdge(const Segment& segment, float at, std::uint32_t first) {
        collector_.triangles.assign(1, first);
        rtcInitIntersectContext(&collector_.context);
        collector_.context.filter = Collector::filter;
        const float tie = kTieDepth * static_cast<float>(segment.length);
        RTCRayHit query = queryOf(segment);
        query.ray.tnear = std::max(0.0F, at - tie);
        query.ray.tfar = at + tie;
        rtcIntersect1(impl_.tree.scene.get(), &collector_.context, &query);

        return bestFacing(segment, first);
    }

    /// Of the collected triangles; `first` is one of them. A front side always beats a back side.
    [[nodiscard]] std::uint32_t bestFacing(const Segment& segment, std::uint32_t first) const {
        std::uint32_t best = first;
        double best_score = -2.0;
        for (const std::uint32_t triangle : collector_.triangles) {
            const TrianglePlane plane = planeOf(*impl_.mesh, triangle);
            const double length =
                std::sqrt(dot(plane.normal, plane.normal) * dot(segment.direction, segment.direction));
            const double facing = -impl_.winding * dot(plane.normal, segment.direction) / length;
            const double score = facing > 0.0 ? facing : -1.0 - facing;
            if (score > best_score || (score == best_score && triangle < best)) {
                best = triangle;
                best_score = score;
            }
        }
        return best;
    }

    /// The depth of a triangle's plane at the texels of an orthographic map: at (x, y) it is
    /// base + x · per_column + y · per_row.
    struct PlaneDepth {
        std::uint32_t triangle = kNone;
        bool from_behind = false;
        bool grazing = false;
        double base = 0.0;
        double per_column = 0.0;
        double per_row = 0.0;
    };

    Hit orthographicHit(std::uint32_t x, std::uint32_t y, std::uint32_t triangle) {
        // Neighbouring texels mostly see the same few triangles.
        PlaneDepth& plane = plane_depths_[triangle % kPlaneDepths];
        if (plane.triangle != triangle) {
            plane = planeDepth(triangle);
        }
        double depth =
            plane.base + static_cast<double>(x) * plane.per_column + static_cast<double>(y) * plane.per_row;
        if (plane.grazing) {
            depth = insideTriangle(view_.ray(0, x, y), triangle, depth);
        }
        return {static_cast<float>(std::clamp(depth, 0.0, 1.0)), triangle, plane.from_behind};
    }

    [[nodiscard]] PlaneDepth planeDepth(std::uint32_t triangle) const {
        const TrianglePlane plane = planeOf(*impl_.mesh, triangle);
        const double along = dot(plane.normal, first_ray_.direction);
        const double per_along = 1.0 / along;
        PlaneDepth depth;
        depth.triangle = triangle;
        depth.from_behind = isFromBehind(along);
        depth.grazing = isGrazing(plane, first_ray_.direction, along);
        depth.base = dot(plane.normal, plane.point - first_ray_.origin) * per_along;
        depth.per_column = -dot(plane.normal, column_step_) * per_along;
        depth.per_row = -dot(plane.normal, row_step_) * per_along;
        return depth;
    }

    [[nodiscard]] Hit cubeHit(const TexelRay& ray, std::uint32_t triangle) const {
        const TrianglePlane plane = planeOf(*impl_.mesh, triangle);
        const double along = dot(plane.normal, ray.direction);
        double depth = dot(plane.normal, plane.point - ray.origin) / along;
        if (isGrazing(plane, ray.direction, along)) {
            depth = insideTriangle(ray, triangle, depth);
        }
        return {static_cast<float>(std::clamp(depth, 0.0, double{kCubeDepthMax})), triangle,
                isFromBehind(along)};
    }

    /// \param along  dot(normal, direction of growing depth)
    [[nodiscard]] bool isFromBehind(double along) const {
        return end_ == RayEnd::kNear ? along > 0.0 : along < 0.0;
    }
    [[nodiscard]] static bool isGrazing(const TrianglePlane& plane, const glm::dvec3& direction,
                                        double along) {
        return !(along * along >
                 kGrazingCosine * kGrazingCosine * dot(plane.normal, plane.normal) * dot(direction, direction));
    }

    /// A depth on a triangle seen almost edge-on, held between the depths of its corners.
    [[nodiscard]] double insideTriangle(const TexelRay& ray, std::uint32_t triangle, double depth) const {
        const glm::uvec3& t = impl_.mesh->triangles[triangle];
        const double per_depth = dot(ray.direction, ray.direction);
        double low = std::numeric_limits<double>::max();
        double high = -low;
        for (const std::uint32_t corner : {t.x, t.y, t.z}) {
            const double at =
                dot(glm::dvec3(impl_.mesh->positions[corner]) - ray.origin, ray.direction) / per_depth;
            low = std::min(low, at);
            high = std::max(high, at);
        }
        return depth >= low && depth <= high ? depth : std::isnan(depth) || depth < low ? low : high;
    }

    const Impl& impl_;
    const View& view_;
    RayEnd end_;
    bool inside_out_;
    std::array<PlaneDepth, kPlaneDepths> plane_depths_;
    RTCIntersectContext context_{};
    Collector collector_;
    // Of an orthographic view: the ray of texel (0, 0), and from one texel's origin to the next one's.
    TexelRay first_ray_{};
    glm::dvec3 column_step_{0.0};
    glm::dvec3 row_step_{0.0};
    // The same as Embree sees it, for the traced segments.
    glm::dvec3 local_origin_{0.0};
    glm::dvec3 local_column_step_{0.0};
    glm::dvec3 local_row_step_{0.0};
    float length_ = 1.0F;
    std::uint32_t valid_columns_ = 0;
    std::uint32_t valid_rows_ = 0;
    alignas(64) int valid_[kLanes] = {};
    alignas(64) float offset_x_[kLanes] = {};
    alignas(64) float offset_y_[kLanes] = {};
    alignas(64) float offset_z_[kLanes] = {};
    alignas(64) RTCRayHit16 packet_{};
};

RayScene::RayScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
RayScene::RayScene(RayScene&&) noexcept = default;
RayScene& RayScene::operator=(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

Result<RayScene> RayScene::build(const TriangleMesh& mesh) {
    auto impl = std::make_unique<Impl>();
    impl->mesh = &mesh;
    impl->winding = orientation(mesh);
    impl->closed = edgesAreEven(mesh);
    EmbreeMesh tree = RELIEF_TRY(EmbreeMesh::build(mesh));
    impl->tree = std::move(tree);
    return RayScene(std::move(impl));
}

double RayScene::winding() const {
    return impl_->winding;
}

void RayScene::trace(const View& view, RayEnd end, const RowRange& rows, std::span<Hit> hits) const {
    const std::uint32_t tile_rows = (rows.end - rows.begin + kTile - 1) / kTile;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, tile_rows), [&](const auto& block) {
        const RowRange part{rows.face, rows.begin + block.begin() * kTile,
                            std::min(rows.begin + block.end() * kTile, rows.end)};
        const std::size_t first = std::size_t{part.begin - rows.begin} * view.width;
        traceRows(view, end, part, hits.subspan(first));
    });
}

void RayScene::traceRows(const View& view, RayEnd end, const RowRange& rows, std::span<Hit> hits) const {
    Impl::Tracer tracer(*impl_, view, end);
    for (std::uint32_t y = rows.begin; y < rows.end; y += kTile) {
        tracer.traceTileRow(rows.face, y, rows.end, &hits[std::size_t{y - rows.begin} * view.width]);
    }
}

struct RayProbe::Impl {
    explicit Impl(RayScene::Impl::Tracer started) : tracer(std::move(started)) {}
    RayScene::Impl::Tracer tracer;
};

RayProbe::RayProbe(const RayScene& scene, const View& view, RayEnd end)
    : impl_(std::make_unique<Impl>(RayScene::Impl::Tracer(*scene.impl_, view, end))) {}
RayProbe::~RayProbe() = default;

Hit RayProbe::trace(std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    return impl_->tracer.traceOne(face, x, y);
}

}  // namespace relief
