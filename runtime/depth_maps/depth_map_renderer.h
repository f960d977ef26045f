// SPDX-License-Identifier: Apache-2.0
// Front-back maps of planes in 16 bits, drawn on the GPU from a mesh that moves: the texels are those of
// formats/README.md, as `relief bake` makes them from one ray through the centre of each texel, to a unit of the last place
// of the depth.
//
// The rasteriser only finds the triangle that a texel's ray meets; the plane is that of the triangle, because rasterisers
// move vertices to a grid of 1/256 pixel. Texels whose centre lies so near to an edge may take the triangle beside it, or
// what lies behind a silhouette. The plane is moved outwards to the next depth code, stands along the ray where it is steep,
// and faces the viewer where no plane can be stored. What the ray caster does with the rays next to a texel (silhouettes
// found between texels' centres) is not done here.
#pragma once

#include <cstdint>

#include "formats/base/result.h"
#include "formats/depth_map.h"
#include "runtime/depth_maps/gpu_mesh.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// Needs a current context, as every call does. Every call restores the GL state that it touches; none waits.
class DepthMapRenderer {
  public:
    /// \param width, height  texels of the largest maps.
    /// Errors: kLimit (beyond this GL's textures, no room), kUnsupported (does not render to them), kFailure.
    [[nodiscard]] static Result<DepthMapRenderer> create(std::uint32_t width, std::uint32_t height);

    /// Draws a whole map over the last one, from texel (0, 0) on.
    /// \param map  valid (formats/validate.h), MapFormat::kFrontBackFixed and Decode::kPlane, no larger than the size of
    ///             create(); texels may be missing. Its rays start in free space if `encloses` is set; otherwise a surface met from its inner side
    ///             leaves the texel empty.
    void render(GpuMesh& mesh, const DepthMap& map) const;

    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    /// The motion of the surface between the mesh's previous and its present positions, object units. Of
    /// end e (0: the front, 1: the back) x is component e of texture 0, y component 2 + e of it, z component e of texture
    /// 1. Whatever was there before where the end is empty.
    /// \param i  0 or 1.
    [[nodiscard]] GLuint motion(int i) const { return motion_[i].name(); }
    [[nodiscard]] GLuint texels() const { return texels_.name(); }  ///< RGBA16UI, as the container has them
    /// To read from: attachment 0 has the texels as the container has them, RGBA16UI; 1 and 2 the motion.
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }

  private:
    void setUniforms(const GpuMesh& mesh, const DepthMap& map) const;

    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    GlProgram program_;
    GlTexture texels_;
    GlTexture motion_[2];
    GlTexture depth_;
    GlFramebuffer framebuffer_;
};

}  // namespace relief
