// SPDX-License-Identifier: Apache-2.0
// The surface of a mesh as it was imported, with a material for each triangle.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "formats/materials.h"

namespace relief {

/// The surface that materials are of. Copies of it are large.
struct MaterialSource {
    std::vector<glm::vec3> positions;   ///< object space
    std::vector<glm::uvec3> triangles;  ///< counter-clockwise seen from outside
    std::vector<std::uint8_t> ids;      ///< of the triangles, in `list`
    std::vector<Material> list;         ///< in the order of the file
    /// It has no sheets, which have one material on both of their sides: a normal tells the sides of a board apart.
    bool sides = true;

    [[nodiscard]] bool empty() const { return list.empty(); }
};

}  // namespace relief
