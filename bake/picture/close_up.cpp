#include "bake/picture/close_up.h"

#include <tbb/parallel_for.h>

#include <cmath>

namespace relief {

CloseUp drawCloseUp(const MeshQuery& query, const Collider& collider, const CloseUpOptions& options) {
    const int right = options.axis == 0 ? 2 : 0;
    const int up = options.axis == 1 ? 2 : 1;
    const double pixel = 2.0 * options.half / options.size;
    CloseUp picture;
    for (RgbImage* image : {&picture.truth, &picture.collider}) {
        *image = {options.size, options.size, {}};
        image->pixels.resize(std::size_t{options.size} * options.size);
    }
    const std::uint32_t inside = toPixel(kInsideColor);
    const std::uint32_t outside = toPixel(kOutsideColor);
    const std::uint32_t false_inside = toPixel(kFalseInsideColor);
    const std::uint32_t false_outside = toPixel(kFalseOutsideColor);
    tbb::parallel_for(std::uint32_t{0}, options.size, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < options.size; ++x) {
            glm::dvec3 p = options.center;
            p[right] += (x + 0.5 - 0.5 * options.size) * pixel;
            p[up] -= (y + 0.5 - 0.5 * options.size) * pixel;
            glm::dvec3 beside = p;
            beside[right] += pixel;
            glm::dvec3 below = p;
            below[up] -= pixel;
            const bool is_inside = query.inside(glm::vec3(p));
            const bool says_inside = evaluate(collider, glm::vec3(p)).inside();
            const std::size_t i = std::size_t{y} * options.size + x;
            // A surface without an inside shows as a line.
            const bool is_surface = !query.segmentIsFree(p, beside) || !query.segmentIsFree(p, below);
            picture.truth.pixels[i] = is_inside || is_surface ? inside : outside;
            picture.collider.pixels[i] =
                is_inside ? (says_inside ? inside : false_outside) : (says_inside ? false_inside : outside);
        }
    });
    return picture;
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
