// SPDX-License-Identifier: Apache-2.0
// Allocates ranges of a row of texels for streamed colliders, first fit.
#pragma once

#include <cstddef>
#include <map>
#include <optional>

namespace relief {

class TexelRanges {
  public:
    TexelRanges(std::size_t first, std::size_t count);

    /// Allocates `count` ≥ 1 texels. \return the first of them; nullopt if no free range is long enough.
    [[nodiscard]] std::optional<std::size_t> take(std::size_t count);
    /// Frees a whole range returned by take().
    void give(std::size_t first, std::size_t count);

    [[nodiscard]] std::size_t free() const { return free_; }

  private:
    std::map<std::size_t, std::size_t> gaps_;  // begin and end of free ranges, coalesced
    std::size_t free_;
};

}  // namespace relief
