// CGAL rotates boxes by libm's functions, whose bits vary with the processor, and with them the result of its search. This
// header, included first, replaces them by those of portable_math.h.
#include "formats/base/portable_libm.h"

#include "bake/mesh/oriented_box.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <glm/geometric.hpp>
#include <utility>

// CGAL's assertions would print; what they check is checked here before or after the call.
#ifndef CGAL_NDEBUG
#define CGAL_NDEBUG 1
#endif
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/optimal_bounding_box.h>

namespace relief {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

/// Flatter points count as a plane; in units of their longest side.
constexpr double kThicknessMin = 1e-5;
/// Far above the rounding of float vertices, far below what a texel resolves.
constexpr double kRounding = 1e-6;

/// Directions of the octahedron's lattice: spread over the sphere, and the same bits everywhere.
std::vector<glm::dvec3> fixedDirections() {
    constexpr int kLattice = 6;
    std::vector<glm::dvec3> directions;
    for (int j = -kLattice; j <= kLattice; ++j) {
        for (int i = -kLattice; i <= kLattice; ++i) {
            const int k = kLattice - std::abs(i) - std::abs(j);
            if (k >= 0) {
                directions.emplace_back(i, j, k);
            }
            if (k > 0) {
                directions.emplace_back(i, j, -k);
            }
        }
    }
    return directions;
}

/// Centred and scaled to a longest side of 1. Empty if the points coincide or are not finite.
std::vector<glm::dvec3> normalizedPoints(std::span<const glm::dvec3> points) {
    if (points.empty()) {
        return {};
    }
    glm::dvec3 low = points.front();
    glm::dvec3 high = points.front();
    for (const glm::dvec3& p : points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 size = high - low;
    const double side = std::max({size.x, size.y, size.z});
    if (!(side > 0.0) || !std::isfinite(side)) {
        return {};
    }
    std::vector<glm::dvec3> scaled;
    for (const glm::dvec3& p : points) {
        scaled.push_back((p - 0.5 * (low + high)) / side);
    }
    return scaled;
}

/// From one point to the farthest, to the farthest from their line, to the farthest from their plane.
bool spanVolume(const std::vector<glm::dvec3>& points) {
    const auto farthest = [&](const auto& distance) {
        return *std::ranges::max_element(points, {}, distance);
    };
    const glm::dvec3 origin = points.front();
    const glm::dvec3 line = farthest([&](const glm::dvec3& p) { return glm::length(p - origin); }) - origin;
    const auto fromLine = [&](const glm::dvec3& p) { return glm::length(glm::cross(p - origin, line)); };
    const glm::dvec3 normal = glm::cross(farthest(fromLine) - origin, line);
    const double size = glm::length(normal);
    if (!(size > kThicknessMin * glm::length(line))) {
        return false;
    }
    const auto fromPlane = [&](const glm::dvec3& p) { return std::abs(glm::dot(p - origin, normal)) / size; };
    return fromPlane(farthest(fromPlane)) > kThicknessMin;
}

double extent(const std::vector<glm::dvec3>& points, const glm::dvec3& axis) {
    const auto [low, high] =
        std::ranges::minmax_element(points, {}, [&](const glm::dvec3& p) { return glm::dot(p, axis); });
    return glm::dot(*high - *low, axis);
}

}  // namespace

std::vector<glm::dvec3> extremeVertices(const VertexBlocks& vertices) {
    std::vector<std::size_t> farthest;
    for (const glm::dvec3& direction : fixedDirections()) {
        farthest.push_back(vertices.farthest(direction));
    }
    std::ranges::sort(farthest);
    farthest.erase(std::unique(farthest.begin(), farthest.end()), farthest.end());
    std::vector<glm::dvec3> points;
    for (const std::size_t i : farthest) {
        points.emplace_back(vertices.positions()[i]);
    }
    return points;
}

std::optional<std::array<glm::dvec3, 3>> orientedBoxAxes(std::span<const glm::dvec3> points) {
    const std::vector<glm::dvec3> scaled = normalizedPoints(points);
    if (scaled.size() < 4 || !spanVolume(scaled)) {
        return std::nullopt;
    }
    std::vector<Kernel::Point_3> input;
    for (const glm::dvec3& p : scaled) {
        input.emplace_back(p.x, p.y, p.z);
    }
    Kernel::Aff_transformation_3 to_box;
    try {
        CGAL::oriented_bounding_box(input, to_box, CGAL::parameters::use_convex_hull(true).random_seed(1U));
    } catch (const std::exception&) {
        return std::nullopt;
    }
    std::array<glm::dvec3, 3> axes;
    for (int i = 0; i < 3; ++i) {
        glm::dvec3& axis = axes[static_cast<std::size_t>(i)];
        for (int k = 0; k < 3; ++k) {
            const double component = to_box.m(i, k);
            axis[k] = std::abs(component) < kRounding ? 0.0 : component;
        }
        // Of two opposite axes, the one whose largest component is positive.
        const glm::dvec3 size = glm::abs(axis);
        const int largest = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        axis *= axis[largest] < 0.0 ? -1.0 : 1.0;
        axis /= glm::length(axis);
    }
    std::ranges::stable_sort(axes, std::greater<>(), [&](const glm::dvec3& a) { return extent(scaled, a); });
    if (glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0.0) {
        axes[2] = -axes[2];
    }
    // Written so that NaN fails too.
    for (std::size_t i = 0; i < 3; ++i) {
        if (!(std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) < 1e-5)) {
            return std::nullopt;
        }
        axes[i] += 0.0;  // no −0
    }
    return axes;
}

std::optional<OrientedBox> orientedBox(const VertexBlocks& vertices) {
    std::vector<glm::dvec3> corners = extremeVertices(vertices);
    const std::optional<std::array<glm::dvec3, 3>> axes = orientedBoxAxes(corners);
    return axes ? std::optional(OrientedBox{std::move(corners), *axes}) : std::nullopt;
}

}  // namespace relief
