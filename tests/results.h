// SPDX-License-Identifier: Apache-2.0
// Helpers for Results that must succeed or fail.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

/// The value of a Result; ends the test on an error.
template <class T>
T required(Result<T> result, const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    if (!result) {
        ADD_FAILURE_AT(file, line) << result.error().message;
    }
    return std::move(result).value();  // throws, which ends the test
}

/// Expects an error with this code and a one-line message that contains these words.
template <class T>
void expectError(const Result<T>& result, ErrorCode code, std::string_view words = {},
                 const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    const testing::ScopedTrace trace(file, line, std::string(words));
    ASSERT_FALSE(result) << "accepted";
    EXPECT_EQ(result.error().code, code) << result.error().message;
    EXPECT_NE(result.error().message.find(words), std::string::npos) << result.error().message;
    EXPECT_EQ(result.error().message.find('\n'), std::string::npos) << result.error().message;
}

/// expectError() with a message that starts with these words.
template <class T>
void expectErrorStart(const Result<T>& result, ErrorCode code, std::string_view start,
                      const char* file = __builtin_FILE(), int line = __builtin_LINE()) {
    expectError(result, code, start, file, line);
    EXPECT_TRUE(result || result.error().message.starts_with(start)) << result.error().message;
}

}  // namespace relief
