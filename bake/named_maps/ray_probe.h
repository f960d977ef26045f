// SPDX-License-Identifier: Apache-2.0
// Traces single rays from one end of a view with Embree. These rays lie between those of scan_convert.h.
#pragma once

#include <array>
#include <cstddef>

#include "bake/mesh/embree_mesh.h"
#include "bake/mesh/triangle_plane.h"
#include "bake/named_maps/projected_plane.h"
#include "bake/named_maps/ray_scene.h"
#include "bake/views/view.h"

namespace relief {

/// Not thread-safe: caches the planes of recent triangles.
class RayProbe {
  public:
    /// \param scene, view  borrowed; must outlive this object.
    RayProbe(const RayScene& scene, const View& view, RayEnd end);

    [[nodiscard]] Hit trace(std::uint32_t face, std::uint32_t x, std::uint32_t y);

  private:
    static constexpr std::size_t kStoredPlanes = 256;

    /// A ray segment that starts slightly outside the volume, along or against the depth.
    struct Segment {
        glm::dvec3 origin;
        glm::dvec3 direction;
        double length;  // in units of `direction`
    };
    [[nodiscard]] Segment segmentOf(const TexelRay& ray) const;
    /// The hit of a texel's ray on a triangle.
    [[nodiscard]] Hit hitOf(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t triangle);
    /// Traces rays beside the original ray, because Embree misses some vertices and edges that a ray hits exactly, even
    /// in robust mode. A triangle in front of `hit` counts if such a ray hits it and the original ray touches it.
    [[nodiscard]] Hit traceBeside(std::uint32_t face, std::uint32_t x, std::uint32_t y, const Hit& hit);
    [[nodiscard]] RTCRayHit traced(const Segment& segment) const;
    /// Whether a line through `origin`, perpendicular to `right` and `up`, passes within kTouching of the triangle.
    [[nodiscard]] bool touches(const glm::dvec3& origin, const glm::dvec3& right, const glm::dvec3& up,
                               std::uint32_t triangle) const;

    const RayScene& scene_;
    const View& view_;
    RayEnd end_;
    bool may_start_inside_;
    ProjectedPlanes planes_;
    /// A cache: neighbouring texels usually hit the same few triangles.
    std::array<ProjectedPlane, kStoredPlanes> known_planes_;
};

}  // namespace relief
