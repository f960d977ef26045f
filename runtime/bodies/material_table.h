// SPDX-License-Identifier: Apache-2.0
// Encodes the materials of bodies as texels of the texture that shaders/bodies/materials.glsl reads. Independent of GL.
#pragma once

#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/materials.h"

namespace relief {

/// Materials of one body; must match materials.glsl.
struct MaterialHead {
    glm::vec4 cube{0.0F};  ///< lowest corner, object space, and 1 / side
    /// x, y: texel indices of the first material (0: none) and of the top grid; z, w: log2 of the cells per side of the
    /// cube in the full octree and in the top grid.
    glm::ivec4 grids{0};
};

struct MaterialTable {
    std::vector<std::string>
        names;  ///< unique names, in the order of the bodies; empty: there are no materials
    std::vector<glm::uvec4> texels;  ///< texture texels, row by row; empty if `names` is
    int log2_width = 0;              ///< log2 of the row length, which is at least the height
    int bricks = 0;                  ///< maximum number of nested bricks (4³ grids) below the top grid
    bool responds = false;           ///< a material changes the reaction of particles
    bool loses = false;              ///< a material shortens lifetimes
    MaterialHead head;               ///< of the body if there is exactly one
};

/// Builds the table. \param bodies  materials of each body; null or empty for none. Bodies may share materials.
[[nodiscard]] MaterialTable makeMaterialTable(std::span<const Materials* const> bodies);

}  // namespace relief
