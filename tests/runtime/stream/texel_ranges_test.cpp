// SPDX-License-Identifier: Apache-2.0
#include "runtime/stream/texel_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace relief {
namespace {

/// Compared with an array of flags.
TEST(TexelRanges, AllocatesTheFirstFitAndMergesFreedRanges) {
    constexpr std::size_t kFirst = 1000;
    constexpr std::size_t kCount = 400;
    TexelRanges ranges(kFirst, kCount);
    std::vector<char> taken(kCount, 0);
    std::vector<std::pair<std::size_t, std::size_t>> held;
    std::mt19937 random(5);
    int refused = 0;
    for (int i = 0; i < 20'000; ++i) {
        if (random() % 2 == 0 && !held.empty()) {
            std::swap(held[random() % held.size()], held.back());
            const auto [first, count] = held.back();
            held.pop_back();
            ranges.give(first, count);
            std::fill_n(taken.begin() + static_cast<std::ptrdiff_t>(first - kFirst), count, 0);
        } else {
            const std::size_t count = 1 + random() % 80;
            const auto place = ranges.take(count);
            const auto gap =
                std::search_n(taken.begin(), taken.end(), static_cast<std::ptrdiff_t>(count), char{0});
            ASSERT_EQ(place.has_value(), gap != taken.end());
            if (place) {
                ASSERT_EQ(*place, kFirst + static_cast<std::size_t>(gap - taken.begin()));
                std::fill_n(gap, count, char{1});
                held.emplace_back(*place, count);
            }
            refused += place ? 0 : 1;
        }
        ASSERT_EQ(ranges.free(), static_cast<std::size_t>(std::count(taken.begin(), taken.end(), 0)));
    }
    EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace relief
