// Where an error comes from, said by the caller who knows it.
#pragma once

#include <string>
#include <utility>

#include "formats/base/result.h"

namespace relief {

/// The same Result; an error's message with "WORDS: " in front.
template <class T>
[[nodiscard]] Result<T> inFront(const std::string& words, Result<T> result) {
    if (!result) {
        result.error().message.insert(0, words + ": ");
    }
    return result;
}

}  // namespace relief
