// The mesh that rays are cast at, and what a ray meets.
#pragma once

#include <cstdint>
#include <utility>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/prepared_mesh.h"
#include "bake/plan/view.h"
#include "formats/base/result.h"

namespace relief {

/// What the ray of one texel meets first, from the end it starts at.
class Hit {
  public:
    Hit() = default;
    /// \param depth  map depth, in [0, 1] or [0, kCubeDepthMax]
    /// \param from_behind  the ray met the side from which the triangle's corners run clockwise.
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

/// Rows of one face of a view, in the order of a map's texels.
struct RowRange {
    std::uint32_t face = 0;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;  ///< one behind the last
};

/// A mesh to be traced, for any number of views, from any thread.
class RayScene {
  public:
    /// Shares the mesh's tree. Errors: those of EmbreeMesh::build.
    [[nodiscard]] static Result<RayScene> build(PreparedMesh mesh);

    [[nodiscard]] const TriangleMesh& mesh() const { return query_.mesh(); }
    /// orientation() of the mesh.
    [[nodiscard]] double winding() const { return winding_; }
    [[nodiscard]] bool closed() const { return closed_; }
    [[nodiscard]] const EmbreeMesh& tree() const { return *tree_; }
    [[nodiscard]] const MeshQuery& query() const { return query_; }

  private:
    RayScene(MeshQuery query, const EmbreeMesh& tree)
        : query_(std::move(query)),
          tree_(&tree),
          winding_(query_.prepared().orientation()),
          closed_(query_.watertight()) {}

    MeshQuery query_;
    const EmbreeMesh* tree_;  // query_ holds it
    double winding_;
    bool closed_;
};

/// Rays of this end that meet an inner side have started in the solid, although the view's empty texels are free.
[[nodiscard]] inline bool mayStartInside(const RayScene& scene, const View& view, RayEnd end) {
    return view.centre_on_surface && end == RayEnd::kNear && scene.closed();
}

/// Of a closed mesh: rays of this end may start in the solid, because of that or of a volume that cuts it.
[[nodiscard]] inline bool raysMayStartInside(const RayScene& scene, const View& view, RayEnd end) {
    return mayStartInside(scene, view, end) ||
           (scene.closed() && !view.starts_free[static_cast<std::size_t>(end)]);
}

}  // namespace relief
