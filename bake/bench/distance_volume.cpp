// SPDX-License-Identifier: Apache-2.0
#include "bake/bench/distance_volume.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <optional>

namespace relief {
namespace {

constexpr double kCodeMax = 32767.0;

glm::uvec3 nodesFor(const glm::dvec3& size, double spacing) {
    glm::uvec3 nodes;
    for (int i = 0; i < 3; ++i) {
        // A side that is a whole number of voxels except for rounding needs no additional voxel.
        const double voxels = std::ceil(size[i] / spacing * (1.0 - 1e-12));
        nodes[i] = static_cast<std::uint32_t>(std::clamp(voxels, 1.0, 4e9)) + 1;
    }
    return nodes;
}

}  // namespace

double DistanceWalk::at(const glm::dvec3& exact) {
    const glm::vec3 p = exact;
    const ClosestPoint closest = query_.closest(p, nearby_);
    // No surface lies between two points if they are closer to each other than one of them is to the surface. The
    // factor allows for the rounding of p.
    const bool same_side =
        nearby_ && query_.watertight() && std::abs(before_) > 1.01 * glm::distance(exact, from_);
    const bool inside = same_side ? before_ < 0.0 : query_.inside(p);
    nearby_ = closest.triangle;
    from_ = exact;
    before_ = inside ? -closest.distance : closest.distance;
    return before_;
}

Lattice makeLattice(const Bounds& box, std::uint64_t nodes_max, LatticeFit fit) {
    const glm::dvec3 size = glm::dvec3(box.max) - glm::dvec3(box.min);
    const auto fits = [&](double spacing) {
        const glm::uvec3 nodes = nodesFor(size, spacing);
        return double{1.0} * nodes.x * nodes.y * nodes.z <= static_cast<double>(nodes_max);
    };
    // The number of nodes never grows with the spacing, and one voxel along the longest side always fits.
    double large = std::max({size.x, size.y, size.z});
    double small = 0.0;
    for (int i = 0; i < 100; ++i) {
        const double middle = 0.5 * (small + large);
        (fits(middle) ? large : small) = middle;
    }
    Lattice lattice;
    lattice.box = box;
    lattice.nodes = nodesFor(size, large);
    const glm::dvec3 voxels = glm::dvec3(lattice.nodes) - 1.0;
    lattice.spacing =
        fit == LatticeFit::kStretched ? glm::max(size / voxels, 1e-9 * large) : glm::dvec3(large);
    lattice.origin = glm::dvec3(box.min);
    if (fit == LatticeFit::kCentered) {
        lattice.origin += 0.5 * (size - large * voxels);
    }
    return lattice;
}

DistanceGrid sampleDistances(const MeshQuery& query, const Lattice& lattice) {
    DistanceGrid grid{lattice, std::vector<float>(lattice.count())};
    const glm::uvec3 nodes = lattice.nodes;
    tbb::parallel_for(std::uint32_t{0}, nodes.y * nodes.z, [&](std::uint32_t row) {
        const std::uint32_t y = row % nodes.y;
        const std::uint32_t z = row / nodes.y;
        DistanceWalk walk(query);
        for (std::uint32_t x = 0; x < nodes.x; ++x) {
            const double distance = walk.at(lattice.origin + lattice.spacing * glm::dvec3(x, y, z));
            grid.distances[std::size_t{row} * nodes.x + x] = static_cast<float>(distance);
        }
    });
    return grid;
}

double DistanceVolume::fullRange(const DistanceGrid& grid) {
    double range = 0.0;
    for (const float distance : grid.distances) {
        range = std::max(range, std::abs(static_cast<double>(distance)));
    }
    return range;
}

double DistanceVolume::bandRange(const DistanceGrid& grid, double reach) {
    // The corners of a voxel are at most its diagonal farther away than any of its points.
    return std::min(fullRange(grid), reach + glm::length(grid.lattice.spacing));
}

DistanceVolume::DistanceVolume(const DistanceGrid& grid, double range)
    : lattice_(grid.lattice), range_(range > 0.0 ? range : 1.0), codes_(grid.distances.size()) {
    tbb::parallel_for(std::size_t{0}, codes_.size(), [&](std::size_t i) {
        const double code = static_cast<double>(grid.distances[i]) / range_ * kCodeMax;
        codes_[i] = static_cast<std::int16_t>(std::lround(std::clamp(code, -kCodeMax, kCodeMax)));
    });
}

FieldValue DistanceVolume::at(const glm::vec3& p) const {
    const glm::dvec3 exact = p;
    const glm::dvec3 in_bounds =
        glm::clamp(exact, glm::dvec3(lattice_.box.min), glm::dvec3(lattice_.box.max));
    const glm::dvec3 in_lattice = (in_bounds - lattice_.origin) / lattice_.spacing;
    std::size_t cell[3];
    double t[3];
    for (int i = 0; i < 3; ++i) {
        const double last = static_cast<double>(lattice_.nodes[i]) - 2.0;
        const double whole = std::clamp(std::floor(in_lattice[i]), 0.0, last);
        cell[i] = static_cast<std::size_t>(whole);
        t[i] = std::clamp(in_lattice[i] - whole, 0.0, 1.0);
    }
    const std::size_t row = lattice_.nodes.x;
    const std::size_t layer = row * lattice_.nodes.y;
    const std::size_t first = cell[2] * layer + cell[1] * row + cell[0];
    const auto code = [&](std::size_t dx, std::size_t dy, std::size_t dz) {
        return static_cast<double>(codes_[first + dz * layer + dy * row + dx]);
    };
    const auto mix = [](double a, double b, double s) { return a + s * (b - a); };
    // Interpolate along x first; [y][z].
    double edge[2][2];
    double slope[2][2];
    for (std::size_t dy = 0; dy < 2; ++dy) {
        for (std::size_t dz = 0; dz < 2; ++dz) {
            const double a = code(0, dy, dz);
            const double b = code(1, dy, dz);
            edge[dy][dz] = mix(a, b, t[0]);
            slope[dy][dz] = b - a;
        }
    }
    const double at_y0 = mix(edge[0][0], edge[0][1], t[2]);
    const double at_y1 = mix(edge[1][0], edge[1][1], t[2]);
    const double value = mix(at_y0, at_y1, t[1]) / kCodeMax * range_;
    const glm::dvec3 per_voxel(
        mix(mix(slope[0][0], slope[0][1], t[2]), mix(slope[1][0], slope[1][1], t[2]), t[1]), at_y1 - at_y0,
        mix(edge[0][1] - edge[0][0], edge[1][1] - edge[1][0], t[1]));
    const glm::dvec3 gradient = per_voxel / lattice_.spacing;

    FieldValue result;
    const double length = glm::length(gradient);
    if (length > 0.0) {
        result.normal = gradient / length;
    }
    const double beyond = glm::length(exact - in_bounds);
    result.distance = static_cast<float>(beyond > 0.0 ? std::max(value, 0.0) + beyond : value);
    return result;
}

BrickAtlas DistanceVolume::atlas() const {
    BrickAtlas atlas;
    atlas.box = lattice_.box;
    atlas.origin = lattice_.origin;
    atlas.cells = lattice_.nodes - 1U;
    atlas.cube_size = lattice_.spacing * glm::dvec3(atlas.cells);
    atlas.range = static_cast<float>(range_);
    atlas.bits = 16;
    atlas.bytes = bytes();
    atlas.index = {BrickAtlas::kFirstBrick};
    atlas.codes = codes_;
    return atlas;
}

Field fieldOf(const DistanceVolume& volume) {
    return [&volume](const glm::vec3& p) -> std::optional<FieldValue> { return volume.at(p); };
}

}  // namespace relief
