// SPDX-License-Identifier: Apache-2.0
#include "formats/plane.h"

#include <glm/geometric.hpp>

namespace relief {

TexelRay texelRay(const DepthMap& map, std::uint32_t face, std::uint32_t x, std::uint32_t y) {
    return rayThrough(map, face, x + 0.5, y + 0.5);
}

TexelRay rayThrough(const DepthMap& map, std::uint32_t face, double x, double y) {
    const glm::vec4* const row = map.object_to_map.row;
    const glm::dvec3 shift(row[0].w, row[1].w, row[2].w);
    const glm::dmat3 object_from_map = map.object_to_map.inverse();
    const glm::dvec3 start = -(object_from_map * shift);  // origin of map space
    const double s = x / map.width;
    const double t = y / map.height;
    if (map.projection() == Projection::kOrthographic) {
        return {start + object_from_map * glm::dvec3(s, t, 0.0), object_from_map[2]};
    }
    const double sc = 2.0 * s - 1.0;
    const double tc = 2.0 * t - 1.0;
    const glm::dvec3 through[6] = {{1.0, -tc, -sc}, {-1.0, -tc, sc}, {sc, 1.0, tc},
                                   {sc, -1.0, -tc}, {sc, -tc, 1.0},  {-sc, -tc, -1.0}};
    return {start, object_from_map * glm::normalize(through[face])};
}

}  // namespace relief
