// The render target of depth maps (depth_map_renderer.h).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "formats/base/result.h"
#include "formats/texel.h"
#include "runtime/depth_maps/depth_map_frame.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// Texels on the GPU, laid out as the container has them, and a depth buffer.
class DepthMapTarget {
  public:
    /// For all of a map, a cube's six faces stacked. The texture of a format is RGBA32F (float), RGBA8 (fixed8, cube) or
    /// RGBA16UI (front-back).
    /// \param motion  with two RGBA32F textures for the motion of the surface.
    /// Errors: those of checkFrame; kLimit (beyond this GL's textures), kUnsupported (does not render to them; names the
    /// extension that is missing).
    [[nodiscard]] static Result<DepthMapTarget> create(const DepthMapFrame& frame, bool motion = false);

    [[nodiscard]] MapFormat format() const { return format_; }
    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }
    [[nodiscard]] GLuint texels() const { return texels_.name(); }
    /// The motion of the surface between the mesh's previous and its present positions, object units. Of
    /// end e (0: the surface of maps that keep one, and the front; 1: the back) x is component e of texture
    /// 0, y component 2 + e of it, z component e of texture 1. 0 where the texel is empty.
    /// \param i  0 or 1.
    /// \return name 0 in a target without motion.
    [[nodiscard]] GLuint motion(int i) const { return motion_[i].name(); }
    /// All attachments; to read from, and to draw to by the renderer.
    [[nodiscard]] GLuint framebuffer() const { return framebuffer_.name(); }

    /// Reads a rectangle back, rows from y on, tightly packed, as the container stores them. Waits for the
    /// GPU.
    /// \param bytes  width · height · texelSize(format()).
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

}  // namespace relief
