// SPDX-License-Identifier: Apache-2.0
// Compares the allocator with a std::set of free indices, which is slow but simple.
#include "runtime/particles/index_allocator.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "runtime/particles/emitter.h"

namespace relief {
namespace {

class IndexAllocatorCapacity : public testing::TestWithParam<std::uint32_t> {};

// Fails on any wrong summary bit at any level: the capacities are just below, at and above a full word of each level of
// the tree.
TEST_P(IndexAllocatorCapacity, AgreesWithASet) {
    const std::uint32_t capacity = GetParam();
    IndexAllocator allocator(capacity);
    std::set<std::uint32_t> free;
    std::set<std::uint32_t> live;
    std::vector<std::uint32_t> live_list;
    for (std::uint32_t i = 0; i < capacity; ++i) {
        free.insert(i);
    }
    EXPECT_FALSE(allocator.release(0));
    Pcg32 random(capacity);
    for (int call = 0; call < 100'000; ++call) {
        // Fills and empties in waves, so that both extremes are reached.
        const bool fill = (call / 20'000) % 2 == 0;
        if (random.uniform() < (fill ? 0.7F : 0.3F)) {
            const auto index = allocator.acquire();
            ASSERT_EQ(index.has_value(), !free.empty());
            if (index) {
                ASSERT_EQ(*index, *free.begin());
                free.erase(free.begin());
                live.insert(*index);
                live_list.push_back(*index);
            }
        } else if (!live_list.empty()) {
            const std::size_t at = random.next() % live_list.size();
            const std::uint32_t index = live_list[at];
            live_list[at] = live_list.back();
            live_list.pop_back();
            ASSERT_TRUE(allocator.release(index));
            ASSERT_FALSE(allocator.release(index)) << "released twice";
            live.erase(index);
            free.insert(index);
        }
        ASSERT_EQ(allocator.liveCount(), live.size());
        ASSERT_EQ(allocator.extent(), live.empty() ? 0 : *live.rbegin() + 1);
    }
    for (std::uint32_t i = 0; i < capacity; ++i) {
        ASSERT_EQ(allocator.isLive(i), live.contains(i));
    }
}

INSTANTIATE_TEST_SUITE_P(Capacities, IndexAllocatorCapacity,
                         testing::Values(1U, 2U, 63U, 64U, 65U, 1000U, 4095U, 4096U, 4097U, 20'000U));

TEST(IndexAllocator, RejectsIndicesBeyondItsCapacity) {
    IndexAllocator allocator(64);
    EXPECT_FALSE(allocator.isLive(64));
    EXPECT_FALSE(allocator.release(64));
    EXPECT_FALSE(allocator.release(0xffffffffU));
    IndexAllocator none(0);
    EXPECT_EQ(none.acquire(), std::nullopt);
    EXPECT_EQ(none.extent(), 0U);
}

}  // namespace
}  // namespace relief
