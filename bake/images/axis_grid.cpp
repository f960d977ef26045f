// SPDX-License-Identifier: Apache-2.0
#include "bake/images/axis_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "formats/base/text.h"

namespace relief {
namespace {

std::string numbers(const glm::vec3& v) {
    return shortest(v.x) + " " + shortest(v.y) + " " + shortest(v.z);
}

}  // namespace

glm::vec3 AxisGrid::point(std::uint32_t x, std::uint32_t y, float at) const {
    glm::vec3 p;
    p[axis()] = at;
    p[right] = static_cast<float>(corner.x + ((leftwards() ? width - 1 - x : x) + 0.5) * spacing);
    p[up] = static_cast<float>(corner.y + ((downwards() ? height - 1 - y : y) + 0.5) * spacing);
    return p;
}

ExrImage AxisGrid::image(double near, const Collider& collider,
                         const std::vector<std::string>& channels) const {
    ExrImage image;
    image.width = width;
    image.height = height;
    for (const std::string& name : channels) {
        image.channels.push_back({name, std::vector<float>(std::size_t{width} * height)});
    }
    // Maps a coordinate of object space to [0, 1] across an extent, in either direction.
    const auto row = [](int along, double low, double extent, bool backwards) {
        const double per_length = (backwards ? -1.0 : 1.0) / extent;
        glm::dvec4 of(0.0, 0.0, 0.0, -(backwards ? low + extent : low) * per_length);
        of[along] = per_length;
        return of;
    };
    const glm::dvec2 area(spacing * width, spacing * height);
    image.setOrthographicCamera(
        row(right, corner.x, area.x, leftwards()), row(up, corner.y, area.y, downwards()),
        row(axis(), sign() > 0.0 ? near : near - 1.0, 1.0, sign() < 0.0), {area.x, area.y, 1.0});
    image.attributes = {{"relief.direction", kDirectionNames[static_cast<std::size_t>(view)]},
                        {"relief.unit", collider.unit},
                        {"relief.bounds_min", numbers(collider.bounds.min)},
                        {"relief.bounds_max", numbers(collider.bounds.max)}};
    return image;
}

Result<AxisGrid> gridAcross(const Bounds& bounds, int view, std::uint32_t size, double margin) {
    AxisGrid grid;
    grid.view = view;
    grid.right = grid.axis() == 0 ? 2 : 0;
    grid.up = grid.axis() == 1 ? 2 : 1;
    const glm::dvec3 low = bounds.min;
    const glm::dvec3 high = bounds.max;
    const glm::dvec2 sides(high[grid.right] - low[grid.right], high[grid.up] - low[grid.up]);
    const double longest = std::max(sides.x, sides.y) > 0.0 ? std::max(sides.x, sides.y) : 1.0;
    grid.spacing = (longest + 2.0 * margin * longest) / size;
    const auto samples = [&](double side) {
        const double count = std::ceil((side + 2.0 * margin * longest) / grid.spacing - 1e-9);
        return static_cast<std::uint32_t>(std::clamp(count, 2.0, static_cast<double>(size)));
    };
    grid.width = samples(sides.x);
    grid.height = samples(sides.y);
    const glm::dvec2 half = 0.5 * grid.spacing * glm::dvec2(grid.width, grid.height);
    const glm::dvec2 center(0.5 * (low[grid.right] + high[grid.right]), 0.5 * (low[grid.up] + high[grid.up]));
    grid.corner = center - half;
    const double farthest = std::max(std::abs(center.x) + half.x, std::abs(center.y) + half.y);
    if (!(sides.x >= 0.0 && sides.y >= 0.0 && farthest < double{std::numeric_limits<float>::max()})) {
        return invalidInput("the collider's bounds are too large for floats; bake it again");
    }
    return grid;
}

}  // namespace relief
