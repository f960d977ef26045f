// Which texels hold live particles. Hands out the smallest free index, so that live particles stay packed at
// the front of the state textures and only the rows up to extent() need to be simulated (paper, section 3.2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace relief {

/// A tree of 64-bit words: level 0 has one bit an index, set while it lives; above it, one bit sums up a word
/// of the level below, in one tree as "full" and in another as "not empty". The smallest free and the largest
/// live index are each one walk from the root: O(log64 capacity) for every call, capacity/4 bits of memory,
/// and no allocation after construction.
class IndexAllocator {
  public:
    explicit IndexAllocator(std::uint32_t capacity);

    /// Takes the smallest free index; nullopt if there is none.
    [[nodiscard]] std::optional<std::uint32_t> acquire();
    /// Gives an index back.
    /// \return false, and nothing changes, if the index is not live.
    bool release(std::uint32_t index);

    [[nodiscard]] bool isLive(std::uint32_t index) const;
    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint32_t liveCount() const { return live_count_; }
    /// The largest live index + 1; 0 if none lives.
    [[nodiscard]] std::uint32_t extent() const { return extent_; }

  private:
    using Level = std::vector<std::uint64_t>;

    [[nodiscard]] std::uint32_t highestLive() const;

    std::uint32_t capacity_ = 0;
    std::uint32_t live_count_ = 0;
    std::uint32_t extent_ = 0;
    Level live_;               ///< level 0; bits at and beyond the capacity are never set
    std::vector<Level> full_;  ///< levels 1…: every index below the bit lives, or lies beyond the capacity
    std::vector<Level> any_;   ///< levels 1…: at least one index below the bit lives
};

}  // namespace relief
