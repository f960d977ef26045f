// The materials of bodies as words, for the texture that shaders/collider/materials.glsl reads. Plain arithmetic, no GL.
#pragma once

#include <cstdint>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/materials.h"

namespace relief {

struct MaterialTable {
    std::vector<std::string>
        names;  ///< different ones, in the order of the bodies; empty: there are no materials
    std::vector<glm::uvec4> texels;  ///< of the texture, row by row; none without names
    int log2_width = 0;              ///< of its rows; it is no higher than wide
    bool responds = false;           ///< some material changes what particles do
};

/// \param bodies  the materials of each; null, or empty: it has none. Bodies may share some.
[[nodiscard]] MaterialTable makeMaterialTable(std::span<const Materials* const> bodies);

}  // namespace relief
