// How large a mesh is, in words, and whether its unit was forgotten.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/collider.h"

namespace relief {

/// Longest sides from here on are few in metres, and common in centimetres and millimetres.
inline constexpr float kForgottenUnitFrom = 100.0F;

/// What forgottenUnit() begins with.
inline constexpr std::string_view kNoUnit = "no unit is named";

/// "2 x 4 x 6 m, from (-1, -2, -3) to (1, 2, 3)"; "object units" without a unit.
[[nodiscard]] std::string boxText(const Bounds& bounds, const std::string& unit);

/// What a box so large would be in centimetres and in millimetres, and the option that says so; nullopt where it is not so
/// large. \param bounds  of a mesh whose unit nobody named.
[[nodiscard]] std::optional<std::string> forgottenUnit(const Bounds& bounds);

}  // namespace relief
