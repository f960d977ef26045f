#include "bake/picture/close_up.h"

#include <cmath>
#include <vector>

#include "bake/picture/pixels.h"

namespace relief {

CloseUp drawCloseUp(const MeshQuery& query, const Collider& collider, const CloseUpOptions& options) {
    const int right = options.axis == 0 ? 2 : 0;
    const int up = options.axis == 1 ? 2 : 1;
    const double pixel = 2.0 * options.half / options.size;
    const auto positionOf = [&](std::uint32_t x, std::uint32_t y) {
        glm::dvec3 p = options.center;
        p[right] += (x + 0.5 - 0.5 * options.size) * pixel;
        p[up] -= (y + 0.5 - 0.5 * options.size) * pixel;
        return p;
    };
    std::vector<char> inside(std::size_t{options.size} * options.size);
    const auto truth = [&](std::uint32_t x, std::uint32_t y) {
        const glm::dvec3 p = positionOf(x, y);
        glm::dvec3 beside = p;
        beside[right] += pixel;
        glm::dvec3 below = p;
        below[up] -= pixel;
        const bool is_inside = query.inside(glm::vec3(p));
        inside[std::size_t{y} * options.size + x] = is_inside ? 1 : 0;
        // A surface without an inside shows as a line.
        const bool is_surface = !query.segmentIsFree(p, beside) || !query.segmentIsFree(p, below);
        return is_inside || is_surface ? kInsideColor : kOutsideColor;
    };
    const auto of_collider = [&](std::uint32_t x, std::uint32_t y) {
        const bool found_inside = evaluate(collider, glm::vec3(positionOf(x, y))).inside();
        return inside[std::size_t{y} * options.size + x] != 0
                   ? (found_inside ? kInsideColor : kFalseOutsideColor)
                   : (found_inside ? kFalseInsideColor : kOutsideColor);
    };
    return {drawPixels(options.size, options.size, truth),
            drawPixels(options.size, options.size, of_collider)};
}

int axisAlong(const glm::dvec3& normal) {
    int axis = 2;
    for (const int other : {1, 0}) {
        if (std::abs(normal[other]) < std::abs(normal[axis]) - 1e-9) {
            axis = other;
        }
    }
    return axis;
}

}  // namespace relief
