// What a bake of planes is told beside its maps: which mistake is worse, and how much work to spend.
#pragma once

#include <cstdint>

#include "formats/fields/field.h"

namespace relief {

/// Which of the two mistakes is worse, in maps whose decode is plane. kInside: doubtful space is solid, so
/// that no particle enters a wall. kOutside: doubtful space is free, so that no free volume is lost.
enum class Prefer : std::uint8_t { kNeither, kInside, kOutside };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Prefer>{"neither", "inside", "outside"};

[[nodiscard]] const char* preferName(Prefer prefer);  ///< "neither", "inside" or "outside"

/// How much work goes into the texels of maps whose decode is plane: rays along each side of a texel's
/// footprint, and rounds of search among neighbouring normals.
enum class Quality : std::uint8_t { kFast, kNormal, kBest };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Quality>{"fast", "normal", "best"};

[[nodiscard]] const char* qualityName(Quality quality);  ///< "fast", "normal" or "best"

}  // namespace relief
