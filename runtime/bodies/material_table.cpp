// SPDX-License-Identifier: Apache-2.0
#include "runtime/bodies/material_table.h"

#include <algorithm>
#include <glm/vec3.hpp>
#include <map>
#include <utility>

#include "shaders/bodies/constants.h"

namespace relief {
namespace {

/// Limits of the top grid: at most 32³ cells, and at most kTopEntries per node.
constexpr int kTopLog2Max = 5;
constexpr std::size_t kTopEntries = 64;

std::uint32_t bitsOf(float value) {
    return __builtin_bit_cast(std::uint32_t, value);
}

/// A cell of the tree: a node or a leaf.
struct TreeCell {
    std::uint32_t node = 0;
    std::uint8_t leaf = 0;
    bool is_leaf = false;
};

/// Converts the tree of a collider into grids; see materials.glsl.
class GridBuilder {
  public:
    GridBuilder(const Materials& materials, std::vector<glm::uvec4>& texels)
        : materials_(materials), texels_(texels) {
        const std::vector<MaterialNode>& nodes = materials.nodes;
        // Nodes follow their parents.
        std::vector<int> levels(nodes.size(), 1);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            depth_ = std::max(depth_, levels[i]);
            std::size_t child = nodes[i].head >> 8U;
            for (std::uint32_t mask = nodes[i].head & 0xFFU; mask != 0; mask &= mask - 1) {
                levels[child++] = levels[i] + 1;
            }
        }
        // Each brick covers two levels.
        const std::size_t most = kTopEntries * nodes.size();
        top_log2_ = depth_ % 2;
        while (top_log2_ + 2 <= std::min(depth_, kTopLog2Max) &&
               (std::size_t{1} << (3 * (top_log2_ + 2))) <= most) {
            top_log2_ += 2;
        }
    }

    /// \return the first texel of the top grid.
    std::uint32_t build() {
        const std::uint32_t top = addGrid(top_log2_);
        place({0, 0, materials_.nodes.empty()}, {top, top_log2_}, glm::uvec3(0), top_log2_);
        for (std::size_t i = 0; i < bricks_.size(); ++i) {
            const auto [texel, node] = bricks_[i];
            place({node, 0, false}, {texel, kBrickLog2}, glm::uvec3(0), kBrickLog2);
        }
        return top;
    }

    [[nodiscard]] int depth() const { return depth_; }
    [[nodiscard]] int topLog2() const { return top_log2_; }
    [[nodiscard]] int bricks() const { return (depth_ - top_log2_) / kBrickLog2; }

  private:
    static constexpr int kBrickLog2 = 2;

    struct Grid {
        std::uint32_t texel;
        int log2;
    };

    std::uint32_t addGrid(int log2) {
        const auto texel = static_cast<std::uint32_t>(texels_.size());
        const std::size_t entries = std::size_t{1} << (3 * log2);
        texels_.resize(texels_.size() + (entries + 3) / 4);
        return texel;
    }

    [[nodiscard]] std::uint32_t entryOf(std::uint8_t leaf) const {
        if (leaf < materials_.list.size()) {
            return leaf;
        }
        const MaterialSides& sides = materials_.sides[leaf - materials_.list.size()];
        return (std::uint32_t{sides.axis} + 1) << 16U | std::uint32_t{sides.towards} << 8U | sides.against;
    }

    void set(const Grid& grid, const glm::uvec3& at, std::uint32_t entry) {
        const std::uint32_t i = at.x + (at.y << grid.log2) + (at.z << (2 * grid.log2));
        texels_[grid.texel + i / 4][static_cast<int>(i % 4)] = entry;
    }

    /// Sets the entries of a cell with a width of 2^log2 entries.
    void place(const TreeCell& cell, const Grid& grid, const glm::uvec3& corner, int log2) {
        if (log2 == 0) {
            std::uint32_t entry = 0;
            if (cell.is_leaf) {
                entry = entryOf(cell.leaf);
            } else {
                bricks_.emplace_back(addGrid(kBrickLog2), cell.node);
                entry = std::uint32_t{kMaterialIsBrick} | bricks_.back().first;
            }
            set(grid, corner, entry);
            return;
        }
        std::uint32_t child = cell.is_leaf ? 0 : materials_.nodes[cell.node].head >> 8U;
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
            TreeCell part = cell;
            if (!cell.is_leaf) {
                const MaterialNode& node = materials_.nodes[cell.node];
                const bool is_node = (node.head >> octant & 1U) != 0;
                part = {is_node ? child++ : 0, node.leaves[octant], !is_node};
            }
            const glm::uvec3 upper(octant & 1U, octant >> 1U & 1U, octant >> 2U);
            place(part, grid, corner + (upper << glm::uvec3(log2 - 1)), log2 - 1);
        }
    }

    const Materials& materials_;
    std::vector<glm::uvec4>& texels_;
    int depth_ = 0;  ///< number of levels of the tree
    int top_log2_ = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> bricks_;  ///< first texel and node of each brick
};

/// Adds the record of a collider; see materials.glsl.
/// \param numbers  numbers of all names so far.
/// \return the head of its bodies.
MaterialHead addRecord(const Materials& materials, std::map<std::string, std::uint32_t>& numbers,
                       MaterialTable& table) {
    const auto first = static_cast<std::uint32_t>(table.texels.size());
    for (const Material& one : materials.list) {
        const auto [found, added] =
            numbers.try_emplace(one.name, static_cast<std::uint32_t>(table.names.size()));
        if (added) {
            table.names.push_back(one.name);
        }
        table.responds =
            table.responds || one.restitution != 1.0F || one.friction != 0.0F || one.lifetime_loss != 0.0F;
        table.loses = table.loses || one.lifetime_loss != 0.0F;
        table.texels.emplace_back(bitsOf(one.restitution), bitsOf(1.0F - one.friction),
                                  bitsOf(one.lifetime_loss), found->second);
    }
    GridBuilder grids(materials, table.texels);
    const std::uint32_t top = grids.build();
    table.bricks = std::max(table.bricks, grids.bricks());
    return {glm::vec4(materials.origin, materials.nodes.empty() ? 0.0F : 1.0F / materials.size),
            glm::ivec4(first, top, grids.depth(), grids.topLog2())};
}

}  // namespace

MaterialTable makeMaterialTable(std::span<const Materials* const> bodies) {
    MaterialTable table;
    table.texels.resize(bodies.size() * kMaterialHeadTexels);
    std::map<std::string, std::uint32_t> numbers;
    std::map<const Materials*, MaterialHead> heads;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        if (bodies[i] == nullptr || bodies[i]->empty()) {
            continue;  // no material starts at texel 0, so a first texel of 0 means none
        }
        const auto [found, added] = heads.try_emplace(bodies[i]);
        if (added) {
            found->second = addRecord(*bodies[i], numbers, table);
        }
        const MaterialHead& head = found->second;
        table.texels[kMaterialHeadTexels * i] = {bitsOf(head.cube.x), bitsOf(head.cube.y),
                                                 bitsOf(head.cube.z), bitsOf(head.cube.w)};
        table.texels[kMaterialHeadTexels * i + 1] = head.grids;
        table.head = bodies.size() == 1 ? head : MaterialHead();
    }
    if (table.names.empty()) {
        return {};
    }
    while ((std::size_t{1} << (2 * table.log2_width)) < table.texels.size()) {
        ++table.log2_width;
    }
    const std::size_t width = std::size_t{1} << table.log2_width;
    table.texels.resize((table.texels.size() + width - 1) / width * width);
    return table;
}

}  // namespace relief
