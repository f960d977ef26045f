// Two colliders by what they say of points, whatever maps they have: what `relief diff` says of two plans.
#pragma once

#include <cstdint>

#include "formats/collider.h"
#include "formats/compare.h"

namespace relief {

/// What both say of the same points.
struct PointsDifference {
    std::uint64_t points = 0;
    std::uint64_t only_a = 0;  ///< inside of a alone, and the next of b alone
    std::uint64_t only_b = 0;
    std::uint64_t distances = 0;  ///< points for which both find a surface
    std::uint64_t one_known = 0;  ///< points for which only one of them does
    DifferenceStatistics
        distance;  ///< over `distances`: signed distances to the nearest surface, object units

    /// Points that are on another side, in percent; 0 of no points.
    [[nodiscard]] double sidesPercent() const;
    friend bool operator==(const PointsDifference&, const PointsDifference&) = default;
};

struct FieldsDifference {
    /// Spread evenly over the box that holds the bounds of both and a tenth of its longest side around them.
    PointsDifference box;
    /// Near the surfaces of both, half of them each: up to a hundredth of that longest side away along each axis.
    PointsDifference near;
    friend bool operator==(const FieldsDifference&, const FieldsDifference&) = default;
};

struct CompareFieldsOptions {
    /// In the box; fewer where both have more than 16 maps together, each of which is asked about each point. As many near
    /// each collider's surface, less those from which no surface is found.
    std::uint32_t points = 10'000;
};

/// The points are those of Halton's sequence, the same each time. Of compareFields(b, a) only only_a and only_b are
/// swapped. \param a, b  valid, as readContainer returns them, and in one unit.
[[nodiscard]] FieldsDifference compareFields(const Collider& a, const Collider& b,
                                             const CompareFieldsOptions& options = {});

}  // namespace relief
