// SPDX-License-Identifier: Apache-2.0
// Unit test of the handle table.
#include "runtime/c_api/call.h"

#include <gtest/gtest.h>

#include <set>

namespace relief {
namespace {

TEST(Handles, AreUniqueAndStayFreed) {
    HandleTable table;
    std::set<std::uintptr_t> all;
    std::vector<std::uintptr_t> live;
    // More than a few blocks at once, then thousands of handles that reuse a few slots.
    for (int i = 0; i < 1000; ++i) {
        live.push_back(table.add(HandleKind::kCollider, std::make_shared<int>(i)));
    }
    all.insert(live.begin(), live.end());
    for (int i = 0; i < 20'000; ++i) {
        const auto at = static_cast<std::size_t>(i % 7);
        const std::uintptr_t old = live[at];
        EXPECT_NE(table.remove(HandleKind::kCollider, old), nullptr);
        EXPECT_EQ(table.remove(HandleKind::kCollider, old), nullptr);
        live[at] =
            table.add(i % 2 == 0 ? HandleKind::kParticles : HandleKind::kCollider, std::make_shared<int>(i));
        EXPECT_TRUE(all.insert(live[at]).second) << "handle was reused";
        if (i % 2 == 0) {
            EXPECT_EQ(table.find(HandleKind::kCollider, live[at]), nullptr);
            EXPECT_NE(table.remove(HandleKind::kParticles, live[at]), nullptr);
            live[at] = table.add(HandleKind::kCollider, std::make_shared<int>(i));
            all.insert(live[at]);
        }
        EXPECT_EQ(table.find(HandleKind::kCollider, old), nullptr);
    }
    for (std::size_t i = 7; i < live.size(); ++i) {
        ASSERT_NE(table.find(HandleKind::kCollider, live[i]), nullptr);
        EXPECT_EQ(*static_cast<int*>(table.find(HandleKind::kCollider, live[i])->get()), static_cast<int>(i));
    }
    for (const std::uintptr_t one : all) {
        EXPECT_NE(one & 7U, 0U) << "could be confused with an aligned pointer";
    }
}

TEST(Call, CatchesExceptions) {
    const std::uint64_t before = callErrors().count();
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw std::bad_alloc(); }), -1);
    EXPECT_STREQ(callErrors().last(), "out of memory");
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw std::runtime_error("two\nlines"); }),
              -1);
    EXPECT_STREQ(callErrors().last(), "two lines");
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw 7; }), -1);
    EXPECT_STREQ(callErrors().last(), "an unknown error");
    EXPECT_EQ(callErrors().count(), before + 3);
}

}  // namespace
}  // namespace relief
