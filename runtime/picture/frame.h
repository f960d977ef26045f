// SPDX-License-Identifier: Apache-2.0
// An off-screen picture with linear colour and depth, supersampled and averaged.
#pragma once

#include <cstdint>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/render_target.h"

namespace relief {

class Frame {
  public:
    static constexpr std::uint64_t kPixelsMax = std::uint64_t{1} << 26;
    /// Up to this number of pixels, each pixel is the mean of 2 × 2 samples, if GL limits permit.
    static constexpr std::uint64_t kSmoothPixelsMax = 9'000'000;

    /// Needs a current context.
    /// \param width, height  pixels of the finished picture, ≥ 1.
    /// Errors: kUsage (a side is 0), kLimit (above kPixelsMax, or GL limits), kUnsupported, kFailure.
    [[nodiscard]] static Result<Frame> create(std::uint32_t width, std::uint32_t height);

    /// Returns the target to draw to.
    [[nodiscard]] RenderTarget target() const;
    /// Returns the finished picture: 3 · width · height bytes, sRGB, top row first. Waits for the GPU.
    [[nodiscard]] std::vector<std::uint8_t> read() const;

    [[nodiscard]] std::uint32_t width() const { return width_; }
    [[nodiscard]] std::uint32_t height() const { return height_; }

  private:
    std::uint32_t width_ = 0;
    std::uint32_t height_ = 0;
    std::uint32_t factor_ = 1;
    GlTexture color_;
    GlTexture depth_;
    GlTexture finished_;
    GlFramebuffer large_;
    GlFramebuffer small_;
    GlProgram program_;
};

}  // namespace relief
