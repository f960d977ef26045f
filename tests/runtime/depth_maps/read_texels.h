// SPDX-License-Identifier: Apache-2.0
// Reads back the last map of a renderer.
#pragma once

#include <cstddef>
#include <cstring>
#include <vector>

#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {

/// In the layout of a container.
inline std::vector<std::byte> readTexels(const DepthMapRenderer& renderer) {
    const PassState state;
    std::vector<GLuint> words(std::size_t{4} * renderer.width() * renderer.height());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, renderer.framebuffer());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glReadPixels(0, 0, static_cast<GLsizei>(renderer.width()), static_cast<GLsizei>(renderer.height()),
                 GL_RGBA_INTEGER, GL_UNSIGNED_INT, words.data());
    std::vector<std::byte> bytes(2 * words.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto word = static_cast<std::uint16_t>(words[i]);
        std::memcpy(&bytes[2 * i], &word, sizeof(word));
    }
    return bytes;
}

}  // namespace relief
