// How far a mesh's vertices reach along a direction, without a look at each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/collider.h"

namespace relief {

/// Vertices by the cells of a grid: those cells are passed over whose box reaches no farther than what was found.
class VertexBlocks {
  public:
    /// \param positions  kept, not copied; at least one, and at most 2^32
    explicit VertexBlocks(std::span<const glm::vec3> positions);

    /// The index of the position with the greatest dot(direction, p), in double; of equals the first. The same as by a
    /// look at each, to the last bit: rounding keeps the order, so that no corner of a box falls short of what is in it.
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
