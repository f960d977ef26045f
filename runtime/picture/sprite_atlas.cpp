// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/sprite_atlas.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/collider_view.h"

namespace relief {
namespace {

std::vector<glm::vec4> premultiplied(std::span<const std::uint8_t> rgba) {
    std::array<float, 256> linear{};
    for (std::size_t i = 0; i < linear.size(); ++i) {
        linear[i] = linearColor(glm::vec3(static_cast<float>(i) / 255.0F)).x;
    }
    std::vector<glm::vec4> texels(rgba.size() / 4);
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const float alpha = static_cast<float>(rgba[4 * i + 3]) / 255.0F;
        texels[i] = {alpha * linear[rgba[4 * i]], alpha * linear[rgba[4 * i + 1]],
                     alpha * linear[rgba[4 * i + 2]], alpha};
    }
    return texels;
}

/// Averages 2 × 2 texels; width and height are even.
std::vector<glm::vec4> halved(const std::vector<glm::vec4>& texels, std::size_t width, std::size_t height) {
    std::vector<glm::vec4> half(texels.size() / 4);
    for (std::size_t y = 0; y < height / 2; ++y) {
        for (std::size_t x = 0; x < width / 2; ++x) {
            const glm::vec4* from = &texels[2 * y * width + 2 * x];
            half[y * (width / 2) + x] = 0.25F * (from[0] + from[1] + from[width] + from[width + 1]);
        }
    }
    return half;
}

}  // namespace

Result<SpriteAtlas> SpriteAtlas::create(std::span<const std::uint8_t> rgba, std::uint32_t width,
                                        std::uint32_t height, std::uint32_t columns, std::uint32_t rows) {
    RELIEF_TRY(checkContext());
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    GLint side_max = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side_max);
    const std::uint32_t limit = std::min(kSideMax, static_cast<std::uint32_t>(std::max(side_max, 1)));
    if (std::max(width, height) > limit) {
        return fail(ErrorCode::kLimit, "an atlas of " + size + " pixels is too large; the maximum side is " +
                                           std::to_string(limit));
    }
    if (width == 0 || height == 0 || rgba.size() != std::size_t{4} * width * height) {
        return fail(ErrorCode::kUsage,
                    "an atlas of " + size + " pixels cannot have " + std::to_string(rgba.size()) + " bytes");
    }
    if (columns == 0 || rows == 0 || width % columns != 0 || height % rows != 0) {
        return fail(ErrorCode::kUsage, "an atlas of " + size + " pixels cannot be divided into " +
                                           std::to_string(columns) + "x" + std::to_string(rows) +
                                           " cells; choose numbers that divide its sides");
    }
    const PassState state;
    clearGlErrors();
    SpriteAtlas atlas;
    atlas.columns_ = static_cast<int>(columns);
    atlas.rows_ = static_cast<int>(rows);
    std::vector<glm::vec4> level = premultiplied(rgba);
    atlas.texture_ = makeTexture2D(GL_RGBA16F, static_cast<GLsizei>(width), static_cast<GLsizei>(height),
                                   GL_RGBA, GL_FLOAT, level.data());
    useTexture(0, atlas.texture_);
    std::uint32_t cell_width = width / columns;
    std::uint32_t cell_height = height / rows;
    while (cell_width % 2 == 0 && cell_height % 2 == 0) {
        level = halved(level, width, height);
        width /= 2;
        height /= 2;
        cell_width /= 2;
        cell_height /= 2;
        ++atlas.last_level_;
        glTexImage2D(GL_TEXTURE_2D, atlas.last_level_, GL_RGBA16F, static_cast<GLsizei>(width),
                     static_cast<GLsizei>(height), 0, GL_RGBA, GL_FLOAT, level.data());
    }
    RELIEF_TRY(checkAllocated("an atlas of " + size + " pixels", "choose a smaller one"));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, atlas.last_level_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return atlas;
}

}  // namespace relief
