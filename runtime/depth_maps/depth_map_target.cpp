#include "runtime/depth_maps/depth_map_target.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

struct TexelLayout {
    GLenum internal_format;
    GLenum format;
    GLenum type;  // of read and upload
};

TexelLayout layoutOf(MapFormat format) {
    switch (format) {
        case MapFormat::kFloat32:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            // Two-byte integers are not among what OpenGL ES 3.0 must read back.
            return {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            break;
    }
    return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
}

}  // namespace

Result<DepthMapTarget> DepthMapTarget::create(const DepthMapFrame& frame, bool motion) {
    RELIEF_TRY(checkContext());
    RELIEF_TRY(checkFrame(frame));
    const MapFormat format = frame.format;
    const std::uint32_t width = frame.width;
    const std::uint32_t height = frame.height * faceCount(frame);
    GLint side = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    GLint viewport[2] = {};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    const auto most = static_cast<std::uint32_t>(std::min({side, viewport[0], viewport[1]}));
    if (std::max(width, height) > most) {
        return fail(ErrorCode::kLimit, "depth maps of " + std::to_string(width) + " x " +
                                           std::to_string(height) +
                                           " texels cannot be rendered at once; this GL takes 1 to " +
                                           std::to_string(most) + " along a side");
    }
    if (isGles() && (motion || format == MapFormat::kFloat32) &&
        !hasGlExtension("GL_EXT_color_buffer_float")) {
        return fail(ErrorCode::kUnsupported,
                    "GL_EXT_color_buffer_float is missing, float depth maps and motion cannot be rendered; "
                    "take another format, or OpenGL 3.3");
    }
    const PassState state;
    DepthMapTarget target;
    target.format_ = format;
    target.width_ = width;
    target.height_ = height;
    const TexelLayout layout = layoutOf(format);
    const auto w = static_cast<GLsizei>(width);
    const auto h = static_cast<GLsizei>(height);
    // Integers of two bytes are allocated as such, whatever they are read back as.
    target.texels_ = makeTexture2D(layout.internal_format, w, h, layout.format,
                                   isFrontBack(format) ? GL_UNSIGNED_SHORT : layout.type);
    target.depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, w, h, GL_DEPTH_COMPONENT, GL_FLOAT);
    std::vector<GLuint> colors = {target.texels_.name()};
    for (int i = 0; motion && i < 2; ++i) {
        target.motion_[i] = makeTexture2D(GL_RGBA32F, w, h, GL_RGBA, GL_FLOAT);
        colors.push_back(target.motion_[i].name());
    }
    target.framebuffer_ = RELIEF_TRY(makeFramebuffer(colors, target.depth_.name()));
    return target;
}

Result<void> DepthMapTarget::read(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
                                  std::span<std::byte> bytes) const {
    const std::size_t texels = std::size_t{width} * height;
    if (x > width_ || width > width_ - x || y > height_ || height > height_ - y ||
        bytes.size() != texels * texelSize(format_)) {
        return fail(ErrorCode::kUsage,
                    "texels to read lie outside of the target, or their room has another size");
    }
    const PassState state;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    const TexelLayout layout = layoutOf(format_);
    const auto readTo = [&](void* to) {
        glReadPixels(static_cast<GLint>(x), static_cast<GLint>(y), static_cast<GLsizei>(width),
                     static_cast<GLsizei>(height), layout.format, layout.type, to);
    };
    if (!isFrontBack(format_)) {
        readTo(bytes.data());
        return {};
    }
    std::vector<std::uint32_t> words(4 * texels);
    readTo(words.data());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto word = static_cast<std::uint16_t>(words[i]);
        std::memcpy(&bytes[2 * i], &word, sizeof(word));
    }
    return {};
}

}  // namespace relief
