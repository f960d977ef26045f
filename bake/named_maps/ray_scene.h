// SPDX-License-Identifier: Apache-2.0
// The mesh that rays are traced against, and the hits of the rays.
#pragma once

#include <cstdint>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "bake/views/view.h"
#include "formats/base/result.h"

namespace relief {

/// The first surface on the ray of a texel, from the end at which the ray starts.
class Hit {
  public:
    Hit() = default;
    /// \param depth  map depth, in [0, 1] or [0, kCubeDepthMax]
    /// \param from_behind  the ray hit the side on which the triangle's corners are clockwise.
    Hit(float depth, std::uint32_t triangle, bool from_behind)
        : depth_(depth), code_(triangle << 1 | (from_behind ? 1U : 0U)) {}

    [[nodiscard]] bool empty() const { return code_ == kNothing; }
    [[nodiscard]] float depth() const { return depth_; }
    [[nodiscard]] std::uint32_t triangle() const { return code_ >> 1; }
    [[nodiscard]] bool fromBehind() const { return (code_ & 1U) != 0; }

  private:
    static constexpr std::uint32_t kNothing = 0xffffffff;  // no triangle: kTriangleMax is far below 2^31

    float depth_ = 0.0F;
    std::uint32_t code_ = kNothing;
};

/// Rows of one face of a view, in the order of the map's texels.
struct RowRange {
    std::uint32_t face = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< one past the last
};

/// A mesh for tracing, shared by any number of views and threads.
class RayScene : public MeshQuery {
  public:
    /// Builds the scene; shares the acceleration structure of the mesh. Errors: those of EmbreeMesh::build.
    [[nodiscard]] static Result<RayScene> build(PreparedMesh mesh) {
        return RayScene(RELIEF_TRY(MeshQuery::build(std::move(mesh))));
    }

    [[nodiscard]] double winding() const { return winding_; }  ///< PreparedMesh::orientation
    [[nodiscard]] bool insideOut() const { return winding_ < 0.0; }
    [[nodiscard]] bool closed() const { return closed_; }

  private:
    explicit RayScene(MeshQuery query)
        : MeshQuery(std::move(query)), winding_(prepared().orientation()), closed_(watertight()) {}

    double winding_;
    bool closed_;
};

/// Returns whether the rays of this end start at a centre on the surface of a closed solid. In this case, a ray whose
/// first hit is on an inner side starts in the solid. Empty texels may still mean outside.
[[nodiscard]] inline bool centreMayBeInSolid(const RayScene& scene, const View& view, RayEnd end) {
    return view.centre_on_surface && end == RayEnd::kNear && scene.closed();
}

/// Returns whether rays of this end may start in a closed solid, because the centre lies on the surface or the volume
/// cuts the solid.
[[nodiscard]] inline bool mayStartInSolid(const RayScene& scene, const View& view, RayEnd end) {
    return centreMayBeInSolid(scene, view, end) || (scene.closed() && !view.startsFree(end));
}

}  // namespace relief
