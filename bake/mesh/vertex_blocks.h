// SPDX-License-Identifier: Apache-2.0
// The support function of a mesh's vertices, without visiting each of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/collider.h"

namespace relief {

/// Vertices by the cells of a grid. Cells whose box reaches no farther than the best so far are skipped.
class VertexBlocks {
  public:
    /// \param positions  kept, not copied; at least one, and at most 2^32
    explicit VertexBlocks(std::span<const glm::vec3> positions);

    /// The index of the position with the greatest dot(direction, p), in double; of equals the first. Exactly the result of
    /// a full scan: rounding is monotonic, so that no corner of a box falls short of its content.
    [[nodiscard]] std::size_t farthest(const glm::dvec3& direction) const;

    [[nodiscard]] std::span<const glm::vec3> positions() const { return positions_; }

  private:
    struct Block {
        Bounds box;
        std::uint32_t begin;  ///< in order_
        std::uint32_t end;
    };
    std::span<const glm::vec3> positions_;
    std::vector<std::uint32_t> order_;
    std::vector<Block> blocks_;
};

}  // namespace relief
