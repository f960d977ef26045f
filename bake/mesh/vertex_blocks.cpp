// SPDX-License-Identifier: Apache-2.0
#include "bake/mesh/vertex_blocks.h"

#include <algorithm>
#include <cmath>

#include "bake/mesh/loops.h"
#include "bake/mesh/mesh.h"

namespace relief {
namespace {

/// Cells along an axis, at most; a surface occupies some hundreds of the cube.
constexpr std::uint32_t kCellsMax = 16;
constexpr double kVerticesPerCell = 4.0;

glm::dvec3 cornerAlong(const Bounds& box, const glm::dvec3& direction) {
    return {direction.x < 0.0 ? box.min.x : box.max.x, direction.y < 0.0 ? box.min.y : box.max.y,
            direction.z < 0.0 ? box.min.z : box.max.z};
}

}  // namespace

VertexBlocks::VertexBlocks(std::span<const glm::vec3> positions) : positions_(positions) {
    const Bounds all = boundsOf(positions);
    const auto cells = static_cast<std::uint32_t>(std::clamp(
        std::cbrt(static_cast<double>(positions.size()) / kVerticesPerCell), 1.0, double{kCellsMax}));
    const glm::dvec3 size = glm::dvec3(all.max) - glm::dvec3(all.min);
    const auto cellOf = [&](const glm::vec3& p) {
        std::uint32_t cell = 0;
        for (int i = 0; i < 3; ++i) {
            const double share = size[i] > 0.0 ? (double{p[i]} - all.min[i]) / size[i] : 0.0;
            cell = cell * cells + std::min(static_cast<std::uint32_t>(share * cells), cells - 1);
        }
        return cell;
    };
    Buckets<std::uint32_t> in_cells(std::size_t{cells} * cells * cells, [&](const auto& visit) {
        for (std::uint32_t i = 0; i < positions.size(); ++i) {
            visit(cellOf(positions[i]), i);
        }
    });
    for (std::size_t cell = 0; cell < in_cells.size(); ++cell) {
        if (!in_cells[cell].empty()) {
            Block& block = blocks_.emplace_back(Block{{}, in_cells.first(cell), in_cells.first(cell + 1)});
            for (const std::uint32_t i : in_cells[cell]) {
                block.box.add(positions[i]);
            }
        }
    }
    order_ = std::move(in_cells.values());
}

std::size_t VertexBlocks::farthest(const glm::dvec3& direction) const {
    const auto reach = [&](const Block& block) { return dot(cornerAlong(block.box, direction), direction); };
    std::size_t found = order_[0];
    double most = dot(glm::dvec3(positions_[found]), direction);
    const auto lookAt = [&](const Block& block) {
        for (std::uint32_t k = block.begin; k < block.end; ++k) {
            const std::size_t i = order_[k];
            const double along = dot(glm::dvec3(positions_[i]), direction);
            if (along > most || (along == most && i < found)) {
                most = along;
                found = i;
            }
        }
    };
    // The most promising block first, so that nearly all others are skipped.
    std::size_t best = 0;
    double best_reach = reach(blocks_[0]);
    for (std::size_t b = 1; b < blocks_.size(); ++b) {
        const double at = reach(blocks_[b]);
        if (at > best_reach) {
            best = b;
            best_reach = at;
        }
    }
    lookAt(blocks_[best]);
    for (const Block& block : blocks_) {
        if (reach(block) >= most) {
            lookAt(block);
        }
    }
    return found;
}

}  // namespace relief
