// Depth maps of every format, rendered from a mesh on the GPU: the texels are those of formats/README.md, as
// `relief bake --backend raycast` makes them from one ray through the centre of each texel, to a unit of the
// last place of the depth.
//
// The rasteriser only says which triangle a texel's ray meets; the depth is that of the triangle's own plane
// at the texel's centre, because rasterisers move vertices to a grid of 1/256 pixel (see DepthMapFrame::exact
// for what that grid still decides). Of surfaces on one ray LESS keeps the nearest, GREATER the farthest;
// front-back maps are drawn twice into one target.
//
// Maps whose decode is Plane hold, in each texel, the plane of the triangle that its centre's ray meets:
// moved outwards to the next depth code, standing along the ray where it is steep, and facing the viewer
// where no plane can be stored. What the ray caster does with the rays next to a texel (silhouettes found
// between texels' centres) is not done here.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>

#include "formats/depth_map.h"
#include "formats/result.h"
#include "runtime/gl_object.h"
#include "runtime/gpu_mesh.h"

namespace relief {

/// Where a map looks from, and what it keeps.
struct DepthMapFrame {
    MapFormat format = MapFormat::kFixed8;
    Compare compare = Compare::kLess;  ///< kBoth if and only if isFrontBack(format)
    Decode decode = Decode::kProjected;
    std::uint32_t width = 0;  ///< texels; a cube's faces are width × width
    std::uint32_t height = 0;
    /// Orthographic: the point of map coordinates (0, 0, 0). Cube: the centre. Object space.
    glm::dvec3 origin{0.0};
    /// Object vectors of one unit along each map axis, orthogonal; a cube's along the axes of object space.
    glm::dvec3 axis[3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    /// The volume holds the whole mesh. It never changes a texel; without it cubes look where their volume
    /// ends, which costs time.
    bool encloses = true;
    /// The rays of the near and of the far end start in free space. Where they may not, a surface met from
    /// its inner side leaves the texel empty.
    bool starts_free[2] = {true, true};
    bool inside_out = false;  ///< the triangles are clockwise seen from outside
    /// Decides by the triangles themselves which texels' centres they hold, and which is the nearest, to
    /// float precision: for baking. Otherwise texels whose centre lies within 1/256 of a texel of an edge may
    /// take the triangle beside it, or what lies behind a silhouette. Takes three vertices a triangle and a
    /// test a fragment more; not with motion.
    bool exact = false;
    /// Plane alone: a standing plane that leaves no more free space behind it than this is kept, in units of
    /// map depth.
    double good_enough = 0.0;
};

/// The frame of a map. Its rays are taken to start in free space where `encloses` says so.
/// \param map  valid (formats/validate.h); texels may be missing.
[[nodiscard]] DepthMapFrame frameOf(const DepthMap& map);

/// A rectangle of texels of one face of a map.
struct TexelWindow {
    std::uint32_t face = 0;
    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
};

/// Texels on the GPU, laid out as the container has them, and a depth buffer.
class DepthMapTarget {
  public:
    /// The texture of a format is RGBA32F (float), RGBA8 (fixed8, cube) or RGBA16UI (front-back).
    /// \param width, height  of the texture: a cube's six faces are stacked.
    /// \param motion  with two RGBA32F textures for the motion of the surface.
    /// Errors: kLimit (beyond this GL's textures), kUnsupported (does not render to them; names the extension
    /// that is missing).
    [[nodiscard]] static Result<DepthMapTarget> create(MapFormat format, std::uint32_t width,
                                                       std::uint32_t height, bool motion = false);
    /// A target for all of a map: width × height · faces.
    [[nodiscard]] static Result<DepthMapTarget> create(const DepthMapFrame& frame, bool motion = false);

    [[nodiscard]] MapFormat format() const { return format_; }
    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    [[nodiscard]] GLuint texels() const { return texels_.name(); }
    /// How far the surface has moved between the mesh's previous and its present positions, object units. Of
    /// end e (0: the surface of maps that keep one, and the front; 1: the back) x is component e of texture
    /// 0, y component 2 + e of it, z component e of texture 1. 0 where the texel is empty. \param i  0 or 1;
    /// name 0 in a target without motion.
    [[nodiscard]] GLuint motion(int i) const { return motion_[i].name(); }
    /// All attachments; to read from, and to draw to by the renderer.
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }

    /// Reads a rectangle back, rows from y on, tightly packed, as the container stores them. Waits for the
    /// GPU. \param bytes  width · height · texelSize(format()).
    [[nodiscard]] Result<void> read(std::uint32_t x, std::uint32_t y, std::uint32_t width,
                                    std::uint32_t height, std::span<std::byte> bytes) const;

  private:
    MapFormat format_ = MapFormat::kFixed8;
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    GlTexture texels_;
    GlTexture motion_[2];
    GlTexture depth_;
    GlFramebuffer framebuffer_;
};

/// Needs a current context, as every call does. Every call restores the GL state that it touches; none waits.
class DepthMapRenderer {
  public:
    [[nodiscard]] static Result<DepthMapRenderer> create();

    /// Renders a whole map into a target of the same format, faces stacked from row 0 on; writes every texel
    /// of it. The first map of a kind compiles its program. Errors: kUsage (a frame that is not right, a
    /// target of another format or too small), kFailure.
    [[nodiscard]] Result<void> render(GpuMesh& mesh, const DepthMapFrame& frame,
                                      const DepthMapTarget& target);
    /// Renders a part of a map to (x, y) of the target: for maps that are larger than a texture.
    [[nodiscard]] Result<void> render(GpuMesh& mesh, const DepthMapFrame& frame, const TexelWindow& window,
                                      const DepthMapTarget& target, std::uint32_t x = 0, std::uint32_t y = 0);

  private:
    struct Program {
        GlProgram program;
        GLint shift, center, row, object, window, residual, origin, scale, width;
        GLint far, starts_free, inside_out, ray, range, good_enough, corner, reach;
    };
    [[nodiscard]] Result<const Program*> programFor(const DepthMapFrame& frame, bool motion);
    static void setUniforms(const Program& program, const GpuMesh& mesh, const DepthMapFrame& frame,
                            const TexelWindow& window, std::uint32_t x, std::uint32_t y);

    std::map<std::string, Program> programs_;  // by their defines
};

}  // namespace relief
