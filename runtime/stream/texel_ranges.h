// SPDX-License-Identifier: Apache-2.0
// Room for the texels of colliders that come and go: ranges of one row of texels, the first that fits.
#pragma once

#include <cstddef>
#include <map>
#include <optional>

namespace relief {

class TexelRanges {
  public:
    TexelRanges(std::size_t first, std::size_t count);

    /// Takes so many texels, at least one; nullopt: no range is long enough.
    [[nodiscard]] std::optional<std::size_t> take(std::size_t count);
    /// Gives back what take() has given, all of it.
    void give(std::size_t first, std::size_t count);

    [[nodiscard]] std::size_t free() const { return free_; }

  private:
    std::map<std::size_t, std::size_t> gaps_;  // first texels and ends, none beside another
    std::size_t free_;
};

}  // namespace relief
