// SPDX-License-Identifier: Apache-2.0
// Renders a moving mesh on the GPU to front-back maps with 16-bit depths, whose texels decode to planes. Texels follow
// formats/README.md. They match texels that `relief bake` fits to one ray, through the texel centre, to within one unit
// in the last place of the depth. Its default is 16 rays per texel; --quality sets 1 or 36.
//
// The rasteriser only determines the triangle that a texel's ray hits. A texel's plane is computed from that triangle
// because rasterisers snap vertices to a grid of 1/256 pixel. Texels with an edge near their centre may get the
// adjacent triangle, or the surface behind a silhouette. The plane is rounded outwards to the next depth code. If it is
// too steep to be stored, the texel stores a plane that faces the viewer. Silhouettes between texel centres are
// missing; only `relief bake` searches for them.
#pragma once

#include <cstdint>

#include "formats/base/result.h"
#include "formats/depth_map.h"
#include "runtime/depth_maps/gpu_mesh.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// Every call needs a current context, restores the GL state that it changes, and does not wait.
class DepthMapRenderer {
  public:
    /// \param width, height  texels of the largest map.
    /// Errors: kLimit (beyond this GL context's texture size, or out of memory), kUnsupported (formats not renderable),
    /// kFailure.
    [[nodiscard]] static Result<DepthMapRenderer> create(std::uint32_t width, std::uint32_t height);

    /// Renders a whole map, from texel (0, 0), over the previous one.
    /// \param map  must pass validateFrame(); MapFormat::kFrontBackFixed and Decode::kPlane, within the size given to
    /// create(); `texels` may be empty. If the map has `encloses` set, rays start in free space. Otherwise, a texel
    /// stays empty if its ray hits the inner side of a surface.
    void render(GpuMesh& mesh, const DepthMap& map) const;
    /// Like render(), inside a PassState of the caller.
    void renderInPass(GpuMesh& mesh, const DepthMap& map) const;

    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    /// Returns a texture with the motion of the surface between the mesh's previous and current positions, in object
    /// units. For surface e (0: front, 1: back), x is component e of texture 0, y is component 2 + e of texture 0, and
    /// z is component e of texture 1. Undefined if the surface is empty.
    /// \param i  0 or 1.
    [[nodiscard]] GLuint motion(int i) const { return motion_[i].name(); }
    [[nodiscard]] GLuint texels() const { return texels_.name(); }  ///< RGBA16UI, in container layout
    /// For reading: attachment 0 has the texels in container layout (RGBA16UI), 1 and 2 the motion.
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }

  private:
    void setUniforms(const GpuMesh& mesh, const DepthMap& map) const;

    bool gles_ = false;  // cached isGles(), which takes microseconds
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    GlProgram program_;
    GlTexture texels_;
    GlTexture motion_[2];
    GlTexture depth_;
    GlFramebuffer framebuffer_;
};

}  // namespace relief
