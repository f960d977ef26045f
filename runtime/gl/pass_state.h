// The GL state in which a pass of Relief runs, whatever the caller's was.
#pragma once

#include "runtime/gl/gl_object.h"

namespace relief {

/// On construction: saves what GlStateGuard saves and, on top of it, what else could spoil a pass (stencil
/// test, dithering, alpha-to-coverage, rasterizer discard, sampler objects, polygon offset, primitive
/// restart, uniform block bindings 0 and 1, 3-D textures, pack buffer and pack/unpack windows; on desktop GL
/// also polygon mode, logic operation, program point size, point sprite origin, sRGB conversion), and
/// switches all of it, blending, depth, cull and scissor test off, so that a draw writes what its shader says
/// and a transfer is tightly packed. On destruction: puts everything back.
class PassState {
  public:
    PassState();
    ~PassState();
    PassState(const PassState&) = delete;
    PassState& operator=(const PassState&) = delete;

  private:
    static constexpr int kSwitchCount = 11;

    GlStateGuard guard_;
    GLboolean switches_[kSwitchCount] = {};
    static constexpr int kWindowCount = 8;

    GLint windows_[kWindowCount] = {};
    GLint pack_buffer_ = 0;
    static constexpr int kBlockCount = 2;

    GLint block_buffer_[kBlockCount] = {};
    GLint64 block_offset_[kBlockCount] = {};
    GLint64 block_size_[kBlockCount] = {};
    GLint textures_3d_[GlStateGuard::kUnits] = {};
    GLint samplers_[GlStateGuard::kUnits] = {};
    GLint polygon_mode_ = 0;
    GLint point_origin_ = 0;
};

}  // namespace relief
