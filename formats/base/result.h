// SPDX-License-Identifier: Apache-2.0
// How every library function of Relief reports failure: a Result, never an exception, exit or message.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace relief {

/// What went wrong, by who can cure it. The value is the exit code of both executables (bake/cli/README.md,
/// "Exit codes").
enum class ErrorCode : int {
    kUsage = 1,         ///< the call itself: option, key or value
    kIo = 2,            ///< a file could not be opened, read or written
    kInvalidInput = 3,  ///< a file was read and its contents are wrong
    kFailure = 4,       ///< baking or running failed although the input is right
    kUnsupported = 5,   ///< right, but not something this build or this machine can do
    kLimit = 6,         ///< larger than a limit of Relief, of the format or of the GL
    kDifference = 7,    ///< a comparison found a difference
};

/// One line for a person: names the file or option and the cure. No trailing newline, no leading "error:".
struct Error {
    ErrorCode code = ErrorCode::kFailure;
    std::string message;
};

template <class T>
using Result = tl::expected<T, Error>;

/// For `return fail(ErrorCode::kIo, "...")` out of any function that returns a Result.
[[nodiscard]] inline tl::unexpected<Error> fail(ErrorCode code, std::string message) {
    return tl::unexpected<Error>(Error{code, std::move(message)});
}

/// The most frequent of them.
[[nodiscard]] inline tl::unexpected<Error> invalidInput(std::string message) {
    return fail(ErrorCode::kInvalidInput, std::move(message));
}

/// Hands the error of one Result on as the error of another.
template <class T>
[[nodiscard]] tl::unexpected<Error> forward(const Result<T>& result) {
    return tl::unexpected<Error>(result.error());
}

/// What a successful Result holds: RELIEF_TRY's last step.
template <class T>
[[nodiscard]] T&& valueOf(Result<T>&& result) {
    return *std::move(result);
}
inline void valueOf(Result<void>&& /*result*/) {}

/// The value of a Result, or out of the calling function with its error: `const View view =
/// RELIEF_TRY(makeView(spec));`. Use it as a statement of its own, or as the whole right side of a
/// declaration or an assignment. A statement expression of GCC and Clang, as no function can return for its
/// caller.
#define RELIEF_TRY(...)                             \
    __extension__({                                 \
        auto relief_tried = (__VA_ARGS__);          \
        if (!relief_tried) {                        \
            return ::relief::forward(relief_tried); \
        }                                           \
        ::relief::valueOf(std::move(relief_tried)); \
    })

/// "file or I/O", "invalid input", …: the words of the exit code table.
[[nodiscard]] const char* errorCodeName(ErrorCode code);

/// The same Result; an error's message with "WORDS: " in front.
template <class T>
[[nodiscard]] Result<T> withPrefix(const std::string& words, Result<T> result) {
    if (!result) {
        result.error().message.insert(0, words + ": ");
    }
    return result;
}

}  // namespace relief
