// SPDX-License-Identifier: Apache-2.0
// The materials of bodies as words, for the texture that shaders/bodies/materials.glsl reads. Plain arithmetic, no GL.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/materials.h"

namespace relief {

/// Of a body: materials.glsl.
struct MaterialHead {
    glm::vec4 cube{0.0F};  ///< lowest corner, object space, and 1 / side
    glm::ivec4 grids{0};   ///< texels of the first material and of the top grid, log2 of the cells of both
};

struct MaterialTable {
    std::vector<std::string>
        names;  ///< different ones, in the order of the bodies; empty: there are no materials
    std::vector<glm::uvec4> texels;  ///< of the texture, row by row; none without names
    int log2_width = 0;              ///< of its rows; it is no higher than wide
    int bricks = 0;                  ///< one within the other at most
    bool responds = false;           ///< some material changes what particles do
    bool loses = false;              ///< some material costs lifetime
    MaterialHead head;               ///< of a single body
};

/// \param bodies  the materials of each; null, or empty: it has none. Bodies may share some.
[[nodiscard]] MaterialTable makeMaterialTable(std::span<const Materials* const> bodies);

}  // namespace relief
