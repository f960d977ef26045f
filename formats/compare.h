// Two colliders, evaluated at the same points: what `relief diff` measures.
#pragma once

#include <cstdint>

#include "formats/collider.h"

namespace relief {

struct PointsDifference {
    std::uint64_t points = 0;
    std::uint64_t only_a = 0;  ///< inside of a alone, and the next of b alone
    std::uint64_t only_b = 0;
    std::uint64_t distances = 0;  ///< points for which both find a surface
    /// Differences of signed distances to the nearest surface, over `distances`; object units.
    double mean = 0.0;
    double percentile_99 = 0.0;  ///< the least that 99 % do not exceed

    /// Points that are on another side, in percent; 0 of no points.
    [[nodiscard]] double sidesPercent() const;
    friend bool operator==(const PointsDifference&, const PointsDifference&) = default;
};

/// The points lie near the surfaces of both, half of them each: up to a hundredth of the longest side of both boxes away
/// along each axis. They are those of Halton's sequence, the same each time; comparePoints(b, a) only swaps only_a and
/// only_b. \param a, b  valid, as readContainer returns them, and in one unit.
/// \param points  near each collider, less those from which no surface is found; fewer where both have more than 16 maps
///                together, each of which is evaluated at each point.
[[nodiscard]] PointsDifference comparePoints(const Collider& a, const Collider& b,
                                             std::uint64_t points = 10'000);

}  // namespace relief
