// SPDX-License-Identifier: Apache-2.0
// std::from_chars and std::to_chars for floating-point numbers, with a fallback for standard libraries that only
// support integers (LLVM up to 16, as in Debian's emscripten).
#pragma once

#include <charconv>
#include <type_traits>
#include <version>

#if !defined(__cpp_lib_to_chars)
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#endif

namespace relief {

#if defined(__cpp_lib_to_chars)

/// Wraps std::from_chars. \param fixed  do not accept an exponent.
template <class Number>
std::from_chars_result fromChars(const char* first, const char* last, Number& value, bool fixed = false) {
    if constexpr (std::is_floating_point_v<Number>) {
        return std::from_chars(first, last, value,
                               fixed ? std::chars_format::fixed : std::chars_format::general);
    } else {
        return std::from_chars(first, last, value);
    }
}

/// Wraps std::to_chars: the shortest text that reads back as the same number.
inline std::to_chars_result toChars(char* first, char* last, float value) {
    return std::to_chars(first, last, value);
}

#else

template <class Number>
std::from_chars_result fromChars(const char* first, const char* last, Number& value, bool fixed = false) {
    if constexpr (std::is_floating_point_v<Number>) {
        // Keep only characters that std::from_chars accepts: strtod would also accept spaces, a plus sign and
        // hexadecimal numbers.
        const std::string_view text(first, static_cast<std::size_t>(last - first));
        const std::string number(text.substr(
            0, std::min(text.find_first_not_of(fixed ? "+-.0123456789infaty" : "+-.0123456789infatyeE"),
                        text.size())));
        char* end = nullptr;
        const auto read =
            static_cast<Number>(std::is_same_v<Number, float> ? std::strtof(number.c_str(), &end)
                                                              : std::strtod(number.c_str(), &end));
        const std::string_view taken(number.c_str(), static_cast<std::size_t>(end - number.c_str()));
        if (taken.empty() || taken.front() == '+') {
            return {first, std::errc::invalid_argument};
        }
        const bool finite = read - read == Number{0};
        if (!finite && taken.find_first_of("0123456789") != std::string_view::npos) {
            return {first + taken.size(), std::errc::result_out_of_range};
        }
        value = read;
        return {first + taken.size(), std::errc{}};
    } else {
        return std::from_chars(first, last, value);
    }
}

inline std::to_chars_result toChars(char* first, char* last, float value) {
    char text[32];
    int length = 0;
    for (int digits = 1; digits <= 9; ++digits) {
        length = std::snprintf(text, sizeof(text), "%.*g", digits, static_cast<double>(value));
        if (std::strtof(text, nullptr) == value) {
            break;
        }
    }
    if (length > last - first) {
        return {last, std::errc::value_too_large};
    }
    std::memcpy(first, text, static_cast<std::size_t>(length));
    return {first + length, std::errc{}};
}

#endif

}  // namespace relief
