// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <span>

#include "tests/engines/engine_cases.h"

namespace relief::engines {

/// Expects that isWithinBounds() holds.
inline void expectEqualFields(const Case& one, std::span<const Answer> answers, Match match) {
    ASSERT_EQ(answers.size(), one.queries.size());
    const Difference difference = compare(one, answers);
    EXPECT_TRUE(difference.isWithinBounds(match)) << difference.text();
    // Otherwise the case proves little.
    EXPECT_GT(difference.inside, one.queries.size() / 8);
    EXPECT_GT(difference.outside, one.queries.size() / 8);
    EXPECT_GT(difference.beyond, one.queries.size() / 50);
    EXPECT_GT(difference.hits, one.queries.size() / 8);
    testing::Test::RecordProperty(one.name, difference.text());
}

}  // namespace relief::engines
