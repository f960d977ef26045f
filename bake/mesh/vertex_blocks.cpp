#include "bake/mesh/vertex_blocks.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "bake/mesh/triangle_plane.h"

namespace relief {
namespace {

/// Cells along an axis, at most: of a surface some hundreds of them hold vertices.
constexpr std::uint32_t kCellsMax = 16;
constexpr double kVerticesPerCell = 4.0;

/// The corner that reaches farthest along a direction.
glm::dvec3 cornerAlong(const Bounds& box, const glm::dvec3& direction) {
    return {direction.x < 0.0 ? box.min.x : box.max.x, direction.y < 0.0 ? box.min.y : box.max.y,
            direction.z < 0.0 ? box.min.z : box.max.z};
}

}  // namespace

VertexBlocks::VertexBlocks(std::span<const glm::vec3> positions)
    : positions_(positions), order_(positions.size()) {
    Bounds all{positions[0], positions[0]};
    for (const glm::vec3& p : positions) {
        all.min = glm::min(all.min, p);
        all.max = glm::max(all.max, p);
    }
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
    std::vector<std::uint32_t> next(std::size_t{cells} * cells * cells + 1, 0);
    for (const glm::vec3& p : positions) {
        ++next[cellOf(p) + 1];
    }
    for (std::size_t i = 1; i < next.size(); ++i) {
        next[i] += next[i - 1];
        if (next[i] > next[i - 1]) {
            blocks_.push_back({{}, next[i - 1], next[i]});
        }
    }
    for (std::uint32_t i = 0; i < positions.size(); ++i) {
        order_[next[cellOf(positions[i])]++] = i;
    }
    for (Block& block : blocks_) {
        block.box = {positions[order_[block.begin]], positions[order_[block.begin]]};
        for (std::uint32_t k = block.begin; k < block.end; ++k) {
            block.box.min = glm::min(block.box.min, positions[order_[k]]);
            block.box.max = glm::max(block.box.max, positions[order_[k]]);
        }
    }
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
    // The most promising first, so that nearly all others fall short of what it holds.
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
