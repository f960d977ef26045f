// "did you mean": the known word nearest to a mistyped one.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace relief {

/// ", did you mean 'X'?" for the known word that is fewest edits (insert, delete, replace, swap neighbours)
/// away, if that is at most a third of the word's length and at least 1; else "". The first of equals wins.
[[nodiscard]] std::string suggestion(std::string_view word, std::span<const std::string_view> known);

}  // namespace relief
