// SPDX-License-Identifier: Apache-2.0
// The limits of all verdicts on colliders. bake/measure/README.md gives their reasons.
#pragma once

#include <cstdint>

namespace relief {

/// Percent of the points near the surface that are on the wrong side. About half of the points beside an absent surface are
/// wrong: at 1 %, 2 % of the surface may be absent. A bake warns above kGoodPercent.
inline constexpr double kGoodPercent = 1.0;
inline constexpr double kFairPercent = 5.0;

/// InsideAccuracy::far_face_percent; unknown with fewer points.
inline constexpr double kGoodInsidePercent = 3.0;
inline constexpr double kFairInsidePercent = 10.0;
inline constexpr std::uint64_t kInsidePointsLeast = 300;

/// Percent of the points near a part that are on the wrong side; of an absent part about half are.
inline constexpr double kPartCoarse = 10.0;
inline constexpr double kPartLost = 25.0;

/// The longest side from which on a lost part counts: so much of the asset's diagonal, twice the distance of the points that
/// the asset is judged by; in metres at most so long, for a person notices a brick on a landscape. Smaller and coarse parts
/// count if together they miss more than kGoodPercent of the points near the surface.
inline constexpr double kNoticeableShare = 0.01;
inline constexpr double kNoticeableMetres = 0.1;
/// A lost part that is there, but has another surface, counts if it is lost by points so far off, too, in units of that length:
/// half as far as those that the asset is judged by. Shells of the default thickness exceed small sheets by less.
inline constexpr double kNoticeableExcess = 0.25;

}  // namespace relief
