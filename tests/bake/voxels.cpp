// SPDX-License-Identifier: Apache-2.0
#include "tests/bake/voxels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "tests/bake/meshes.h"

namespace relief::test {

VoxelGrid::VoxelGrid(const glm::ivec3& size)
    : size_(size), full_(static_cast<std::size_t>(size.x) * size.y * size.z, false) {}

VoxelGrid VoxelGrid::random(std::uint32_t seed) {
    std::mt19937 random(seed);
    // Avoids library distributions, which are not portable.
    const auto below = [&](std::uint32_t n) { return static_cast<int>(random() % n); };
    VoxelGrid grid({2 + below(6), 2 + below(6), 2 + below(6)});
    const auto share = 30U + random() % 60U;
    const bool blocks = random() % 2 == 0;
    if (blocks) {  // overlapping blocks: larger flat faces, notches and steps
        const int count = 2 + below(5);
        for (int i = 0; i < count; ++i) {
            glm::ivec3 low;
            glm::ivec3 high;
            for (int k = 0; k < 3; ++k) {
                low[k] = below(static_cast<std::uint32_t>(grid.size_[k]));
                high[k] = low[k] + 1 + below(static_cast<std::uint32_t>(grid.size_[k] - low[k]));
            }
            for (int z = low.z; z < high.z; ++z) {
                for (int y = low.y; y < high.y; ++y) {
                    for (int x = low.x; x < high.x; ++x) {
                        grid.set({x, y, z}, true);
                    }
                }
            }
        }
        return grid;
    }
    for (int z = 0; z < grid.size_.z; ++z) {
        for (int y = 0; y < grid.size_.y; ++y) {
            for (int x = 0; x < grid.size_.x; ++x) {
                grid.set({x, y, z}, random() % 100U < share);
            }
        }
    }
    grid.set(grid.size_ / 2, true);
    return grid;
}

std::size_t VoxelGrid::indexOf(const glm::ivec3& cell) const {
    return (static_cast<std::size_t>(cell.z) * size_.y + cell.y) * size_.x + cell.x;
}

bool VoxelGrid::full(const glm::ivec3& cell) const {
    for (int k = 0; k < 3; ++k) {
        if (cell[k] < 0 || cell[k] >= size_[k]) {
            return false;
        }
    }
    return full_[indexOf(cell)];
}

void VoxelGrid::set(const glm::ivec3& cell, bool full) {
    full_[indexOf(cell)] = full;
}

TriangleMesh VoxelGrid::mesh(const glm::dvec3& origin, double scale) const {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    std::map<std::tuple<int, int, int>, std::uint32_t> index;
    const auto vertex = [&](const glm::ivec3& p) {
        const auto [at, added] =
            index.try_emplace({p.x, p.y, p.z}, static_cast<std::uint32_t>(positions.size()));
        if (added) {
            positions.emplace_back(origin + scale * glm::dvec3(p));
        }
        return at->second;
    };
    for (int z = 0; z < size_.z; ++z) {
        for (int y = 0; y < size_.y; ++y) {
            for (int x = 0; x < size_.x; ++x) {
                const glm::ivec3 cell(x, y, z);
                for (int side = 0; full(cell) && side < 6; ++side) {
                    const int axis = side / 2;
                    const int up = side % 2;
                    glm::ivec3 beside = cell;
                    beside[axis] += up == 1 ? 1 : -1;
                    if (full(beside)) {
                        continue;
                    }
                    glm::ivec3 corner = cell;
                    corner[axis] += up;
                    glm::ivec3 u(0);
                    glm::ivec3 v(0);
                    u[(axis + 1) % 3] = 1;
                    v[(axis + 2) % 3] = 1;
                    if (up == 0) {
                        std::swap(u, v);
                    }
                    const std::uint32_t a = vertex(corner);
                    const std::uint32_t b = vertex(corner + u);
                    const std::uint32_t c = vertex(corner + u + v);
                    const std::uint32_t d = vertex(corner + v);
                    triangles.emplace_back(a, b, c);
                    triangles.emplace_back(a, c, d);
                }
            }
        }
    }
    return finished(std::move(positions), std::move(triangles));
}

bool VoxelGrid::inside(const glm::dvec3& p) const {
    return full({static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                 static_cast<int>(std::floor(p.z))});
}

double VoxelGrid::distance(const glm::dvec3& p, int reach) const {
    const bool here = inside(p);
    const glm::ivec3 at(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)),
                        static_cast<int>(std::floor(p.z)));
    double best = reach;
    for (int z = at.z - reach; z <= at.z + reach; ++z) {
        for (int y = at.y - reach; y <= at.y + reach; ++y) {
            for (int x = at.x - reach; x <= at.x + reach; ++x) {
                const glm::ivec3 cell(x, y, z);
                if (full(cell) == here) {
                    continue;
                }
                double square = 0.0;
                for (int k = 0; k < 3; ++k) {
                    const double off = std::max({cell[k] - p[k], p[k] - (cell[k] + 1), 0.0});
                    square += off * off;
                }
                best = std::min(best, std::sqrt(square));
            }
        }
    }
    return best;
}

}  // namespace relief::test
