// SPDX-License-Identifier: Apache-2.0
#include "runtime/stream/texel_ranges.h"

#include <iterator>

namespace relief {

TexelRanges::TexelRanges(std::size_t first, std::size_t count) : free_(count) {
    if (count > 0) {
        gaps_[first] = first + count;
    }
}

std::optional<std::size_t> TexelRanges::take(std::size_t count) {
    for (auto gap = gaps_.begin(); gap != gaps_.end(); ++gap) {
        const auto [first, end] = *gap;
        if (end - first >= count) {
            gaps_.erase(gap);
            if (end - first > count) {
                gaps_[first + count] = end;
            }
            free_ -= count;
            return first;
        }
    }
    return std::nullopt;
}

void TexelRanges::give(std::size_t first, std::size_t count) {
    std::size_t end = first + count;
    free_ += count;
    auto next = gaps_.lower_bound(first);
    if (next != gaps_.end() && next->first == end) {
        end = next->second;
        next = gaps_.erase(next);
    }
    if (next != gaps_.begin() && std::prev(next)->second == first) {
        std::prev(next)->second = end;
    } else {
        gaps_[first] = end;
    }
}

}  // namespace relief
