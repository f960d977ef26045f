// Depth maps of every format, rendered from a mesh on the GPU: the texels are those of formats/README.md, as `relief bake`
// makes them from one ray through the centre of each texel, to a unit of the last place of the depth.
//
// The rasteriser only finds the triangle that a texel's ray meets; the depth is that of the triangle's own plane at the
// texel's centre, because rasterisers move vertices to a grid of 1/256 pixel. Texels whose centre lies so near to an edge
// may take the triangle beside it, or what lies behind a silhouette. Of surfaces on one ray LESS keeps the nearest, GREATER
// the farthest; front-back maps are drawn twice into one target.
//
// Maps whose decode is Plane hold, in each texel, the plane of the triangle that its centre's ray meets:
// moved outwards to the next depth code, standing along the ray where it is steep, and facing the viewer
// where no plane can be stored. What the ray caster does with the rays next to a texel (silhouettes found
// between texels' centres) is not done here.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "formats/base/result.h"
#include "runtime/depth_maps/depth_map_frame.h"
#include "runtime/depth_maps/depth_map_target.h"
#include "runtime/depth_maps/gpu_mesh.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// Needs a current context, as every call does. Every call restores the GL state that it touches; none waits.
class DepthMapRenderer {
  public:
    [[nodiscard]] static Result<DepthMapRenderer> create();

    /// Renders a whole map into a target of the same format, faces stacked from row 0 on; writes every texel
    /// of it. The first map of a kind compiles its program. Errors: kUsage (a frame that is not right, a
    /// target of another format or too small), kFailure.
    [[nodiscard]] Result<void> render(GpuMesh& mesh, const DepthMapFrame& frame,
                                      const DepthMapTarget& target);

  private:
    [[nodiscard]] Result<const GlProgram*> programFor(const DepthMapFrame& frame, bool motion);
    static void setUniforms(const GlProgram& program, const GpuMesh& mesh, const DepthMapFrame& frame,
                            std::uint32_t face);

    std::map<std::string, GlProgram> programs_;  // by their defines
};

}  // namespace relief
