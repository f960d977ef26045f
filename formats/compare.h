// Two colliders: what `relief diff` reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "formats/collider.h"

namespace relief {

/// A property that two colliders have different values of, in words: {"decode", "plane", "projected"}.
struct Difference {
    std::string what;
    std::string a;
    std::string b;
    friend bool operator==(const Difference&, const Difference&) = default;
};

struct MapDifference {
    std::vector<Difference> structure;  ///< format, size, compare, decode, transform, flags
    bool same_texels = false;           ///< in every bit
};

struct ColliderDifference {
    std::vector<Difference> structure;   ///< bounds, unit, number of maps
    std::vector<Difference> provenance;  ///< mesh and tool: where a collider comes from, not what it is
    std::vector<MapDifference> maps;     ///< of those that both have, in order: map i of a and map i of b

    /// Whether the colliders differ in anything but their provenance.
    [[nodiscard]] bool any() const;
};

/// Compares b with a, map by map. \param a, b  valid, as readContainer returns them.
[[nodiscard]] ColliderDifference compareColliders(const Collider& a, const Collider& b);

/// Statistics of the amounts by which distances differ.
struct DifferenceStatistics {
    std::uint64_t differing = 0;  ///< amounts above 0
    double max = 0.0;
    double mean = 0.0;
    double percentile_99 = 0.0;  ///< the least amount that 99 % do not exceed
    friend bool operator==(const DifferenceStatistics&, const DifferenceStatistics&) = default;
};

/// Both colliders, evaluated at the same points.
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
    /// In the box; fewer where both have more than 16 maps together, each of which is evaluated at each point. As many near
    /// each collider's surface, less those from which no surface is found.
    std::uint32_t points = 10'000;
};

/// The points are those of Halton's sequence, the same each time. Of compareFields(b, a) only only_a and only_b are
/// swapped. \param a, b  valid, as readContainer returns them, and in one unit.
[[nodiscard]] FieldsDifference compareFields(const Collider& a, const Collider& b,
                                             const CompareFieldsOptions& options = {});

}  // namespace relief
