// SPDX-License-Identifier: Apache-2.0
// Settings of a bake that apply to all maps with fitted planes.
#pragma once

#include <cstdint>

#include "formats/base/field.h"

namespace relief {

/// How to classify doubtful space, for maps whose decode is plane. kInside: as solid, so that no particle enters a
/// wall. kOutside: as free, so that no free volume is lost.
enum class Prefer : std::uint8_t { kNeither, kInside, kOutside };

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Prefer>{"neither", "inside", "outside"};

/// The effort per texel for maps whose decode is plane: rays along each side of a texel's footprint, and rounds of
/// search among neighbouring normals.
enum class Quality : std::uint8_t { kFast, kNormal, kBest };

template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<Quality>{"fast", "normal", "best"};

}  // namespace relief
