// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/surface_parts.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace relief {
namespace {

/// Maximum area of outliers, and maximum longest side of the remaining box, as fractions of the whole.
constexpr double kOutlierAreaMax = 0.01;
constexpr double kRestMax = 0.1;

double distanceTo(const glm::dvec3& center, const Bounds& bounds) {
    const glm::dvec3 low = center - glm::dvec3(bounds.min);
    const glm::dvec3 high = glm::dvec3(bounds.max) - center;
    return std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y),
                     std::abs(high.z)});
}

/// Returns the area-weighted median along each axis, which outliers do not affect.
glm::dvec3 medianOf(const std::vector<SurfacePart>& parts, double area) {
    glm::dvec3 median(0.0);
    std::vector<std::size_t> order(parts.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::stable_sort(order, {}, [&](std::size_t i) { return parts[i].bounds.center()[axis]; });
        double sum = 0.0;
        for (const std::size_t i : order) {
            sum += parts[i].area;
            if (2.0 * sum >= area) {
                median[axis] = static_cast<double>(parts[i].bounds.center()[axis]);
                break;
            }
        }
    }
    return median;
}

}  // namespace

void SurfaceParts::add(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles, PartKind kind) {
    part_of.resize(mesh.triangles.size(), kNoLabel);
    std::map<std::uint32_t, std::uint32_t> part_of_label;
    for (const std::uint32_t i : triangles) {
        const std::uint32_t label = mesh.labels.empty() ? kNoLabel : mesh.labels[i];
        const auto [found, is_new] =
            part_of_label.try_emplace(label, static_cast<std::uint32_t>(parts.size()));
        if (is_new) {
            parts.emplace_back().kind = kind;
            if (label < mesh.surface_names.size()) {
                const SurfaceName& name = mesh.surface_names[label];
                parts.back().node_index = name.node_index;
                parts.back().node = name.node;
                parts.back().material = name.material;
            }
        }
        SurfacePart& part = parts[found->second];
        addTriangle(part.bounds, mesh, i);
        part.area += 0.5 * length(planeOf(mesh, i).normal);
        ++part.triangles;
        part_of[i] = found->second;
    }
}

OutlierParts findOutlierParts(const std::vector<SurfacePart>& parts) {
    double area = 0.0;
    Bounds whole;
    for (const SurfacePart& part : parts) {
        area += part.area;
        addBounds(whole, part.bounds);
    }
    OutlierParts strays;
    if (parts.size() < 2) {
        return strays;
    }
    const glm::dvec3 median = medianOf(parts, area);
    std::vector<std::uint32_t> order(parts.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return distanceTo(median, parts[i].bounds); });
    // Outliers are within the farthest 1 % of the area, starting at the first part whose removal shrinks the box.
    double kept = 0.0;
    Bounds rest;
    for (std::size_t k = 0; k < order.size(); ++k) {
        const SurfacePart& part = parts[order[k]];
        const bool may_go = kept >= (1.0 - kOutlierAreaMax) * area;
        if (may_go && double{rest.longestSide()} <= kRestMax * double{whole.longestSide()} &&
            distanceTo(median, part.bounds) > 2.0 * double{rest.longestSide()}) {
            strays.parts.assign(order.begin() + static_cast<std::ptrdiff_t>(k), order.end());
            std::ranges::sort(strays.parts);
            strays.rest = rest;
            return strays;
        }
        kept += part.area;
        addBounds(rest, part.bounds);
    }
    return strays;
}

}  // namespace relief
