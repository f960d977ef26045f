// Numbers as text of a mesh file.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// The whole of the text, white space at its ends left out, as a finite number.
[[nodiscard]] std::optional<double> finiteNumber(std::string_view text);

/// Of a text that is no finite number: "'10,5' is no number; write a point for the comma".
[[nodiscard]] std::string noFiniteNumber(std::string_view text);

}  // namespace relief
