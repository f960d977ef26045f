// Single rays of one end of a view. Also what packets of rays ask about one ray: at what depth it meets a
// triangle, which of the triangles that share an edge counts, and what it slipped past.
#pragma once

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "bake/mesh/embree_mesh.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/plan/view.h"
#include "bake/texels/plane_depth.h"
#include "bake/texels/ray_scene.h"

namespace relief {

/// A ray as it is traced: from a little outside the volume, along or against the depth.
struct RaySegment {
    glm::dvec3 origin;
    glm::dvec3 direction;
    double length;  ///< of the parameter
};

/// Not thread-safe: it remembers the triangles that it met last.
class RayProbe {
  public:
    /// \param scene, view  borrowed; must outlive it.
    RayProbe(const RayScene& scene, const View& view, RayEnd end);

    [[nodiscard]] Hit trace(std::uint32_t face, std::uint32_t x, std::uint32_t y);

    /// Inline, as the next: packets ask for every ray.
    [[nodiscard]] RaySegment segmentOf(const TexelRay& ray) const {
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
    /// The hit of a texel's ray with a triangle.
    [[nodiscard]] Hit hitOf(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t triangle) {
        return view_.projection() == Projection::kOrthographic ? orthographicHit(x, y, triangle)
                                                               : cubeHit(view_.ray(face, x, y), triangle);
    }
    /// The ray met the side that a closed mesh turns inwards.
    [[nodiscard]] bool metInside(const Hit& hit) const { return hit.fromBehind() != inside_out_; }

    /// The triangle that traceRows (raycast.h) promises among those that the ray meets about `at`.
    /// \param first  one of them
    [[nodiscard]] std::uint32_t bestAtEdge(const RaySegment& segment, float at, std::uint32_t first);
    /// Robust or not, Embree lets some rays that are aimed exactly at a vertex or edge pass. So others look
    /// beside the ray: what they meet before `hit` counts if the ray itself touches it.
    [[nodiscard]] Hit lookAgain(std::uint32_t face, std::uint32_t x, std::uint32_t y, const Hit& hit);

  private:
    static constexpr std::size_t kKnownPlanes = 256;
    static constexpr std::uint32_t kNone = 0xffffffff;

    struct KnownPlane {
        std::uint32_t triangle = kNone;
        PlaneDepth depth;
    };

    /// Collects the triangles that one ray meets, and lets it pass through them.
    struct Collector {
        RTCIntersectContext context{};
        std::vector<std::uint32_t> triangles;

        static void filter(const RTCFilterFunctionNArguments* args);
    };

    Hit orthographicHit(std::uint32_t x, std::uint32_t y, std::uint32_t triangle) {
        // Neighbouring texels mostly see the same few triangles.
        KnownPlane& plane = known_planes_[triangle % kKnownPlanes];
        if (plane.triangle != triangle) {
            plane = {triangle, planes_.of(triangle)};
        }
        double depth = plane.depth.at(x, y);
        if (plane.depth.grazing) {
            depth = insideTriangle(mesh_, triangle, view_.ray(0, x, y), depth);
        }
        return {static_cast<float>(std::clamp(depth, 0.0, 1.0)), triangle, isFromBehind(plane.depth.along)};
    }

    /// The segment in Embree's units.
    [[nodiscard]] RTCRayHit queryOf(const RaySegment& segment) const;
    [[nodiscard]] Hit cubeHit(const TexelRay& ray, std::uint32_t triangle) const;
    /// \param along  dot(normal, direction of growing depth)
    [[nodiscard]] bool isFromBehind(double along) const {
        return end_ == RayEnd::kNear ? along > 0.0 : along < 0.0;
    }
    /// Whether a line through `origin`, square to `right` and `up`, passes a triangle within kTouching.
    [[nodiscard]] bool touches(const glm::dvec3& origin, const glm::dvec3& right, const glm::dvec3& up,
                               std::uint32_t triangle) const;
    /// Chooses among the collected triangles; `first` is one of them. A front side always beats a back side.
    [[nodiscard]] std::uint32_t bestFacing(const RaySegment& segment, std::uint32_t first) const;

    const TriangleMesh& mesh_;
    const EmbreeMesh& tree_;
    double winding_;
    const View& view_;
    RayEnd end_;
    bool inside_out_;
    bool closed_;
    PlaneDepths planes_;  // for an orthographic view
    std::array<KnownPlane, kKnownPlanes> known_planes_;
    Collector collector_;
};

}  // namespace relief
