// SPDX-License-Identifier: Apache-2.0
// Defines the limits of all verdicts on colliders. bake/measure/README.md explains them.
#pragma once

#include <cstdint>

namespace relief {

/// Percentage of misclassified points near the surface. About half of the points next to a missing surface are
/// misclassified, so at 1 %, up to 2 % of the surface may be missing. A bake warns above kGoodPercent.
inline constexpr double kGoodPercent = 1.0;
inline constexpr double kFairPercent = 5.0;

/// InsideAccuracy::far_face_percent; not graded with fewer than kInsidePointsMin points.
inline constexpr double kGoodInsidePercent = 3.0;
inline constexpr double kFairInsidePercent = 10.0;
inline constexpr std::uint64_t kInsidePointsMin = 300;

/// Percentage of misclassified points near a part; about 50 for a missing part.
inline constexpr double kPartCoarse = 10.0;
inline constexpr double kPartLost = 25.0;

/// Minimum length of a lost part that counts, as a fraction of the asset's diagonal: about twice the standard deviation
/// of the offset of points near the surface. If the unit is metres, at most kNoticeableMetres, because a person notices
/// a brick on a landscape. Smaller lost parts and coarse parts count if, because of them, more than kGoodPercent of the
/// points near the surface are falsely outside.
inline constexpr double kNoticeableShare = 0.01;
inline constexpr double kNoticeableMetres = 0.1;
/// A lost part may exist with a slightly different surface. It is therefore tested again at this distance, a fraction
/// of the minimum length above, and counts only if it is lost there, too. The distance is about half the standard
/// deviation above. Default shells extend beyond small sheets by less than this distance.
inline constexpr double kNoticeableExcess = 0.25;

}  // namespace relief
