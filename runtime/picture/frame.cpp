// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/frame.h"

#include <algorithm>
#include <array>
#include <string>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {

Result<Frame> Frame::create(std::uint32_t width, std::uint32_t height) {
    RELIEF_TRY(checkContext());
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    if (width == 0 || height == 0) {
        return fail(ErrorCode::kUsage, "a picture of " + size + " pixels is empty; sides must be at least 1");
    }
    GLint side_max = 0;
    std::array<GLint, 2> viewport_max{};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side_max);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport_max.data());
    const auto limit = static_cast<std::uint32_t>(std::min({side_max, viewport_max[0], viewport_max[1]}));
    const std::uint64_t pixels = std::uint64_t{width} * height;
    if (std::max(width, height) > limit || pixels > kPixelsMax) {
        return fail(ErrorCode::kLimit, "a picture of " + size +
                                           " pixels is too large; this GL context supports sides up to " +
                                           std::to_string(limit) + ", and Relief supports " +
                                           std::to_string(kPixelsMax) + " pixels");
    }
    Frame frame;
    frame.width_ = width;
    frame.height_ = height;
    frame.factor_ = 2 * std::max(width, height) <= limit && pixels <= kSmoothPixelsMax ? 2 : 1;

    const PassState state;
    clearGlErrors();
    const RenderTarget large = frame.target();
    frame.color_ = makeTexture2D(GL_RGBA16F, large.width, large.height, GL_RGBA, GL_HALF_FLOAT);
    frame.depth_ =
        makeTexture2D(GL_DEPTH_COMPONENT32F, large.width, large.height, GL_DEPTH_COMPONENT, GL_FLOAT);
    frame.finished_ = makeTexture2D(GL_RGBA8, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                                    GL_RGBA, GL_UNSIGNED_BYTE);
    RELIEF_TRY(checkAllocated("a picture of " + size + " pixels", "choose a smaller size"));
    frame.large_ = RELIEF_TRY(makeFramebuffer({frame.color_.name()}, frame.depth_.name()));
    frame.small_ = RELIEF_TRY(makeFramebuffer({frame.finished_.name()}));
    frame.program_ = RELIEF_TRY(makeScreenProgram("picture/resolve.frag"));
    frame.program_.use();
    frame.program_.set("u_color", 0);
    frame.program_.set("u_factor", static_cast<GLint>(frame.factor_));
    return frame;
}

RenderTarget Frame::target() const {
    return {large_.name(), static_cast<GLsizei>(width_ * factor_), static_cast<GLsizei>(height_ * factor_)};
}

std::vector<std::uint8_t> Frame::read() const {
    const PassState state;
    const auto width = static_cast<GLsizei>(width_);
    const auto height = static_cast<GLsizei>(height_);
    useTexture(0, color_);
    program_.drawScreen(small_.name(), width, height);

    // Every OpenGL ES can read RGBA. Rows start at the bottom.
    std::vector<std::uint8_t> rgba(std::size_t{4} * width_ * height_);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    std::vector<std::uint8_t> rgb(std::size_t{3} * width_ * height_);
    for (std::size_t y = 0; y < height_; ++y) {
        const std::uint8_t* from = &rgba[(height_ - 1 - y) * 4 * width_];
        std::uint8_t* to = &rgb[y * 3 * width_];
        for (std::size_t x = 0; x < width_; ++x) {
            std::copy_n(from + 4 * x, 3, to + 3 * x);
        }
    }
    return rgb;
}

}  // namespace relief
