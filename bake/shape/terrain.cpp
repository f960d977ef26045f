// SPDX-License-Identifier: Apache-2.0
#include "bake/shape/terrain.h"

#include <utility>

namespace relief {

SolidPart extruded(const Sheet& sheet, int axis, float bottom) {
    PartBuilder builder;
    const auto count = static_cast<std::uint32_t>(sheet.positions.size());
    for (const glm::vec3& p : sheet.positions) {
        builder.addPosition(p);
    }
    for (glm::vec3 p : sheet.positions) {
        p[axis] = bottom;
        builder.addPosition(p);
    }
    // Upwards, regardless of the sheet's winding.
    const bool turn = !(shadowOf(sheet).signed_area[axis] > 0.0);
    const auto corners = [&](std::uint32_t i) {
        const glm::uvec3& t = sheet.triangles[i];
        return turn ? glm::uvec3(t.x, t.z, t.y) : t;
    };
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3 t = corners(i);
        builder.addTriangle(i, t.x, t.y, t.z);
    }
    builder.endSurface();
    for (std::uint32_t i = 0; i < sheet.triangles.size(); ++i) {
        const glm::uvec3 t = corners(i);
        builder.addTriangle(i, count + t.x, count + t.z, count + t.y);
        for (int side = 0; side < 3; ++side) {
            if (sheet.neighbours[i][side] == Sheet::kNoTriangle) {
                const glm::uvec3& s = sheet.triangles[i];
                const auto [from, to] = std::pair{s[side], s[(side + 1) % 3]};
                const auto [a, b] = turn ? std::pair{to, from} : std::pair{from, to};
                builder.addWall(i, {a, count + a}, {b, count + b});
            }
        }
    }
    return builder.take();
}

}  // namespace relief
