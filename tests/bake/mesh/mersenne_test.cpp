// SPDX-License-Identifier: Apache-2.0
// Mersenne64 generates the numbers of the standard library's engine.
#include "bake/mesh/mersenne.h"

#include <gtest/gtest.h>

#include <random>

namespace relief {
namespace {

TEST(Mersenne64, MatchesTheStandardLibrary) {
    for (const std::uint64_t seed : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{5489},
                                     std::uint64_t{0x9e3779b97f4a7c15U}, ~std::uint64_t{0}}) {
        Mersenne64 ours(seed);
        std::mt19937_64 theirs(seed);
        for (int i = 0; i < 2000; ++i) {  // six refills of the state
            ASSERT_EQ(ours(), theirs()) << "number " << i << " of seed " << seed;
        }
    }
    // The check of the C++ standard ([rand.predef]): the 10000th number of the default seed.
    Mersenne64 standard(5489);
    for (int i = 1; i < 10000; ++i) {
        standard();
    }
    EXPECT_EQ(standard(), 9981545732273789042U);
}

}  // namespace
}  // namespace relief
