// SPDX-License-Identifier: Apache-2.0
// Error handling of Relief's libraries: functions return a Result; they never throw, exit or print.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace relief {

/// Error category, which determines who can fix the error. The value is the exit code of `relief` and `relief-sim`
/// (bake/cli/README.md, "Exit codes").
enum class ErrorCode : int {
    kUsage = 1,         ///< invalid option, key or value in the call
    kIo = 2,            ///< a file could not be opened, read or written
    kInvalidInput = 3,  ///< a file was read but its contents are invalid
    kFailure = 4,       ///< valid input, but baking or running failed
    kUnsupported = 5,   ///< valid input that this build or machine does not support
    kLimit = 6,         ///< exceeds a limit of Relief, the format or the GL
    kDifference = 7,    ///< a comparison found a difference
};

/// A one-line message that names the file or option and the fix. No trailing newline, no leading "error:".
struct Error {
    ErrorCode code = ErrorCode::kFailure;
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// Creates an error to return from any function that returns a Result: `return fail(ErrorCode::kIo, "...")`.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::unexpected<Error>(Error{code, std::move(message)});
}

/// Shorthand for fail(ErrorCode::kInvalidInput, …).
[[nodiscard]] inline tl::unexpected<Error> invalidInput(std::string message) {
    return fail(ErrorCode::kInvalidInput, std::move(message));
}

/// Forwards the error of one Result type to another.
template <class T>
[[nodiscard]] tl::unexpected<Error> forward(const Result<T>& result) {
    return tl::unexpected<Error>(result.error());
}

/// Unwraps a successful Result for RELIEF_TRY.
template <class T>
[[nodiscard]] T&& valueOf(Result<T>&& result) {
    return *std::move(result);
}
inline void valueOf(Result<void>&& /*result*/) {}

/// Evaluates to the value of a Result, or returns its error from the calling function:
/// `const View view = RELIEF_TRY(makeView(spec));`. Use it as a statement, or as the whole right side of a declaration
/// or assignment. A function cannot make its caller return, so the macro is a statement expression of GCC and Clang.
#define RELIEF_TRY(...)                             \
    __extension__({                                 \
        auto relief_tried = (__VA_ARGS__);          \
        if (!relief_tried) {                        \
            return ::relief::forward(relief_tried); \
        }                                           \
        ::relief::valueOf(std::move(relief_tried)); \
    })

/// Returns the name used in the exit code table: "file or I/O", "invalid input", …
[[nodiscard]] const char* errorCodeName(ErrorCode code);

/// Prepends "WORDS: " to the message of a failed Result.
template <class T>
[[nodiscard]] Result<T> withPrefix(const std::string& words, Result<T> result) {
    if (!result) {
        result.error().message.insert(0, words + ": ");
    }
    return result;
}

}  // namespace relief
