// Maps rendered on the GPU, one ray through the centre of each texel: the alternative to scan_convert.h and encode.h.
#pragma once

#include <cstdint>
#include <functional>

#include "bake/mesh/prepared_mesh.h"
#include "bake/plan/view.h"
#include "formats/base/result.h"
#include "formats/depth_map.h"
#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/depth_maps/gpu_mesh.h"

namespace relief {

/// A mesh on the GPU, rendered for any number of views, all on one thread.
class Rasterizer {
  public:
    /// Needs a current context (gl_context.h), which must outlive it.
    /// Errors: those of GpuMesh::create, with the mesh's name.
    [[nodiscard]] static Result<Rasterizer> create(const PreparedMesh& mesh);

    /// Renders one map, tile by tile: a map may be larger than the GL's textures.
    /// \param covered   receives the number of texels with a surface.
    /// \param rowsDone  called with the number of rows finished, of any face.
    /// Errors: those of DepthMapTarget and DepthMapRenderer.
    [[nodiscard]] Result<DepthMap> bake(const View& view, Decode decode, std::uint64_t& covered,
                                        const std::function<void(std::uint32_t)>& rowsDone);

  private:
    Rasterizer(PreparedMesh mesh, GpuMesh gpu_mesh, DepthMapRenderer renderer)
        : mesh_(std::move(mesh)), gpu_mesh_(std::move(gpu_mesh)), renderer_(std::move(renderer)) {}

    PreparedMesh mesh_;
    GpuMesh gpu_mesh_;
    DepthMapRenderer renderer_;
};

}  // namespace relief
