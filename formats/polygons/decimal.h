// SPDX-License-Identifier: Apache-2.0
// Numbers of the text formats that are read here: OBJ, OFF and STL.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace relief {

/// A decimal number: a sign, digits with or without a point among, before or behind them, an exponent; or nan and inf, in
/// any case. Up to a unit in the last place, it is the float that is nearest: integer and fraction are rounded each by
/// itself and then added, as bakes have always had it, so that they keep their bytes.
/// \return nullopt for what is no number.
[[nodiscard]] std::optional<float> readDecimal(std::string_view word);

/// "'word'" for a message, made clean and cut where it is long.
[[nodiscard]] std::string quotedWord(std::string_view word);

/// "'0x1p0' is hexadecimal; write it as a decimal number", of a word that is no number. With a cure.
[[nodiscard]] std::string noNumber(std::string_view word);

}  // namespace relief
