// SPDX-License-Identifier: Apache-2.0
// Names of enumerators in files, options and reports.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <type_traits>

namespace relief {

/// Names of the enumerators, in the order of their values, which count from 0. Specialize it beside the enumeration.
template <class Enum>
inline constexpr std::array<std::string_view, 0> kWordsOf{};

template <class Enum>
concept WithWords = std::is_enum_v<Enum> &&(kWordsOf<Enum>.size() > 0);

template <WithWords Enum>
[[nodiscard]] constexpr std::string_view wordOf(Enum value) {
    return kWordsOf<Enum>.at(static_cast<std::size_t>(value));
}

template <WithWords Enum>
[[nodiscard]] constexpr std::optional<Enum> fromWord(std::string_view word) {
    for (std::size_t i = 0; i < kWordsOf<Enum>.size(); ++i) {
        if (kWordsOf<Enum>[i] == word) {
            return static_cast<Enum>(i);
        }
    }
    return std::nullopt;
}

}  // namespace relief
