// SPDX-License-Identifier: Apache-2.0
// Numbers in OBJ, OFF and STL text files.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// Parses a decimal number: an optional sign, digits with an optional point, and an optional exponent; or nan, inf
/// or infinity in any letter case. The result may differ from the nearest float: the integer and the first 15 digits of
/// the fraction are rounded separately and then added. Keep this rounding, because the bytes of bakes depend on it.
/// \return nullopt if the word is not a number.
[[nodiscard]] std::optional<float> readDecimal(std::string_view word);

/// Returns "'word'" for a message, truncated and converted by cleanUtf8().
[[nodiscard]] std::string quotedWord(std::string_view word);

/// Explains why a word is not a number, with a fix: "'0x1p0' is hexadecimal; write it as a decimal number".
[[nodiscard]] std::string noNumber(std::string_view word);

}  // namespace relief
