// SPDX-License-Identifier: Apache-2.0
#include "bake/picture/slice.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace relief {
namespace {

constexpr double kMargin = 0.1;  // round the bounds, in units of their longer side in the plane

}  // namespace

glm::vec3 Slice::point(std::uint32_t x, std::uint32_t y) const {
    glm::vec3 p;
    p[axis] = at;
    p[right] = static_cast<float>(corner.x + (x + 0.5) * spacing);
    p[up] = static_cast<float>(corner.y + (y + 0.5) * spacing);
    return p;
}

Result<Slice> evaluateSlice(const Collider& collider, const SliceOptions& options) {
    if (options.size < 2) {
        return fail(ErrorCode::kUsage,
                    "--size is " + std::to_string(options.size) + " but must be at least 2");
    }
    if (options.size > kSliceSizeMax) {
        return fail(ErrorCode::kLimit, "--size is " + std::to_string(options.size) + "; the limit is " +
                                           std::to_string(kSliceSizeMax));
    }
    Slice slice;
    slice.axis = options.axis;
    slice.right = options.axis == 0 ? 2 : 0;
    slice.up = options.axis == 1 ? 2 : 1;
    const glm::dvec3 low = collider.bounds.min;
    const glm::dvec3 high = collider.bounds.max;
    slice.at = options.at.value_or(static_cast<float>(0.5 * (low[slice.axis] + high[slice.axis])));

    const glm::dvec2 sides(high[slice.right] - low[slice.right], high[slice.up] - low[slice.up]);
    const double longest = std::max(sides.x, sides.y);
    const double margin = kMargin * (longest > 0.0 ? longest : 1.0);
    const glm::dvec2 area = sides + 2.0 * margin;
    slice.spacing = std::max(area.x, area.y) / options.size;
    const auto samples = [&](double side) {
        return static_cast<std::uint32_t>(
            std::clamp(std::ceil(side / slice.spacing - 1e-9), 2.0, static_cast<double>(options.size)));
    };
    slice.width = samples(area.x);
    slice.height = samples(area.y);
    slice.corner = {0.5 * (low[slice.right] + high[slice.right]) - 0.5 * slice.spacing * slice.width,
                    0.5 * (low[slice.up] + high[slice.up]) - 0.5 * slice.spacing * slice.height};
    constexpr double kLargest = std::numeric_limits<float>::max();
    const double farthest = std::max({std::abs(slice.corner.x), std::abs(slice.corner.y),
                                      std::abs(slice.corner.x + slice.spacing * slice.width),
                                      std::abs(slice.corner.y + slice.spacing * slice.height)});
    if (!(sides.x >= 0.0 && sides.y >= 0.0 && farthest < kLargest)) {
        return fail(ErrorCode::kInvalidInput, "the collider's bounds cannot be sliced; bake it again");
    }

    slice.samples.resize(std::size_t{slice.width} * slice.height);
    tbb::parallel_for(std::uint32_t{0}, slice.height, [&](std::uint32_t y) {
        for (std::uint32_t x = 0; x < slice.width; ++x) {
            slice.samples[std::size_t{y} * slice.width + x] = evaluate(collider, slice.point(x, y));
        }
    });
    return slice;
}

}  // namespace relief
