// The handles' table and the sizes of structures, by themselves.
#include "runtime/c_api/call.h"

#include <gtest/gtest.h>

#include <set>

namespace relief {
namespace {

TEST(Handles, NoneIsGivenOutTwiceAndOldOnesStayFreed) {
    HandleTable table;
    std::set<std::uintptr_t> all;
    std::vector<std::uintptr_t> live;
    // More than a few blocks at once, then thousands in the places of a few.
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
        EXPECT_TRUE(all.insert(live[at]).second) << "given out before";
        if (i % 2 == 0) {
            EXPECT_EQ(table.find(HandleKind::kCollider, live[at]), nullptr);
            EXPECT_EQ(table.faultOf(HandleKind::kCollider, live[at]), HandleFault::kOtherKind);
            EXPECT_NE(table.remove(HandleKind::kParticles, live[at]), nullptr);
            live[at] = table.add(HandleKind::kCollider, std::make_shared<int>(i));
            all.insert(live[at]);
        }
        EXPECT_EQ(table.faultOf(HandleKind::kCollider, old), HandleFault::kFreed);
    }
    for (std::size_t i = 7; i < live.size(); ++i) {
        ASSERT_NE(table.find(HandleKind::kCollider, live[i]), nullptr);
        EXPECT_EQ(*static_cast<int*>(table.find(HandleKind::kCollider, live[i])->get()), static_cast<int>(i));
    }
    for (const std::uintptr_t one : all) {
        EXPECT_NE(one & 7U, 0U) << "an aligned pointer could be one";
    }
}

// A structure that has grown twice, from a program of each version, and from some that never were.
TEST(Sizes, OlderOnesAreReadAsFarAsTheyGo) {
    struct Third {
        std::size_t size = 0;
        float first = 0.0F;
        float second = 0.0F;
        double third = 0.0;
    };
    constexpr std::array<std::size_t, 3> kVersions{offsetof(Third, second), offsetof(Third, third),
                                                   sizeof(Third)};
    Third given{0, 1.0F, 2.0F, 3.0};
    for (std::size_t version = 0; version < kVersions.size(); ++version) {
        given.size = kVersions[version];
        Third all;
        ASSERT_TRUE(copyKnown(std::as_writable_bytes(std::span(&all, 1)), &given, given.size, kVersions));
        EXPECT_EQ(all.first, 1.0F);
        EXPECT_EQ(all.second, version >= 1 ? 2.0F : 0.0F);
        EXPECT_EQ(all.third, version >= 2 ? 3.0 : 0.0);
    }
    for (const std::size_t size : {std::size_t{0}, std::size_t{3}, sizeof(std::size_t), sizeof(Third) - 1,
                                   sizeof(Third) + 8, std::size_t{4096}, ~std::size_t{0}}) {
        Third all;
        EXPECT_FALSE(copyKnown(std::as_writable_bytes(std::span(&all, 1)), &given, size, kVersions)) << size;
    }
}

TEST(Call, NoExceptionPasses) {
    const std::uint64_t before = callErrors().count();
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw std::bad_alloc(); }), -1);
    EXPECT_STREQ(callErrors().last(), "there is not enough memory");
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw std::runtime_error("two\nlines"); }),
              -1);
    EXPECT_STREQ(callErrors().last(), "two lines");
    EXPECT_EQ(answer("f", -1, [](const Call&) -> Result<int> { throw 7; }), -1);
    EXPECT_STREQ(callErrors().last(), "an unknown error");
    EXPECT_EQ(callErrors().count(), before + 3);
}

}  // namespace
}  // namespace relief
