// SPDX-License-Identifier: Apache-2.0
#include "bake/named_maps/highest_below.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>

namespace relief {
namespace {

/// Maximum number of exchanges. Random points take about a dozen; more mean that rounding makes the search cycle.
constexpr int kExchanges = 64;
/// Tolerance for rounding, in units of the points' extent.
constexpr double kTiny = 1e-9;

/// Returns the barycentric coordinates of (x, y).
std::array<double, 3> weightsOf(const std::array<glm::dvec3, 3>& corners, double x, double y) {
    const glm::dvec3& a = corners[0];
    const glm::dvec3 b = corners[1] - a;
    const glm::dvec3 c = corners[2] - a;
    const double inverse = 1.0 / (b.x * c.y - b.y * c.x);
    const double second = ((x - a.x) * c.y - (y - a.y) * c.x) * inverse;
    const double third = (b.x * (y - a.y) - b.y * (x - a.x)) * inverse;
    return {1.0 - second - third, second, third};
}

glm::dvec2 slopeOf(const std::array<glm::dvec3, 3>& corners) {
    const glm::dvec3 b = corners[1] - corners[0];
    const glm::dvec3 c = corners[2] - corners[0];
    const double inverse = 1.0 / (b.x * c.y - b.y * c.x);
    return {(b.z * c.y - c.z * b.y) * inverse, (c.z * b.x - b.z * c.x) * inverse};
}

}  // namespace

std::optional<glm::dvec2> highestBelow(std::span<const glm::dvec3> points) {
    glm::dvec3 extent(0.0);
    for (const glm::dvec3& p : points) {
        extent = glm::max(extent, glm::abs(p));
    }
    if (!(std::min(extent.x, extent.y) > 0.0)) {
        return std::nullopt;
    }
    // Three auxiliary corners, far away and high up, contain the origin; they are replaced one by one.
    const double far = 8.0 * (extent.x + extent.y);
    const double high = 1e3 * (extent.z + extent.x + extent.y);
    std::array<glm::dvec3, 3> corners = {{{-far, -far, high}, {far, -far, high}, {0.0, far, high}}};
    std::array<bool, 3> is_auxiliary = {true, true, true};
    std::array<double, 3> origin = weightsOf(corners, 0.0, 0.0);
    for (int exchange = 0; exchange < kExchanges; ++exchange) {
        const glm::dvec2 slope = slopeOf(corners);
        const double base = corners[0].z - slope.x * corners[0].x - slope.y * corners[0].y;
        const glm::dvec3* lowest = nullptr;
        double least = -kTiny * (extent.z + std::abs(base));
        for (const glm::dvec3& p : points) {
            const double above = p.z - (base + slope.x * p.x + slope.y * p.y);
            if (above < least) {
                least = above;
                lowest = &p;
            }
        }
        if (lowest == nullptr) {
            const bool any_auxiliary = is_auxiliary[0] || is_auxiliary[1] || is_auxiliary[2];
            return any_auxiliary ? std::nullopt : std::optional(slope);
        }
        // Replace the corner whose weight vanishes first as the weight of the new corner grows.
        const std::array<double, 3> weights = weightsOf(corners, lowest->x, lowest->y);
        std::size_t leaves = 3;
        double most = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            if (weights[i] > kTiny && (leaves == 3 || origin[i] < most * weights[i])) {
                leaves = i;
                most = origin[i] / weights[i];
            }
        }
        if (leaves == 3) {
            return std::nullopt;
        }
        for (std::size_t i = 0; i < 3; ++i) {
            origin[i] = i == leaves ? most : std::max(0.0, origin[i] - most * weights[i]);
        }
        corners[leaves] = *lowest;
        is_auxiliary[leaves] = false;
    }
    return std::nullopt;
}

}  // namespace relief
