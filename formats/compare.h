// Two colliders texel by texel: what `relief diff` says.
#pragma once

#include <cstddef>
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

/// Statistics of the amounts by which surfaces differ; surfaces that are the same count as 0.
struct DifferenceStatistics {
    std::uint64_t differing = 0;  ///< amounts above 0
    double max = 0.0;
    double mean = 0.0;
    double percentile_99 = 0.0;  ///< the least amount that 99 % do not exceed
    friend bool operator==(const DifferenceStatistics&, const DifferenceStatistics&) = default;
};

/// One end of all texels of a map: the front, or the back of a front-back map. The total is of both ends of all maps.
struct EndDifference {
    std::uint64_t ends = 0;    ///< looked at: one a texel
    std::uint64_t both = 0;    ///< with a surface in a and in b
    std::uint64_t only_a = 0;  ///< with a surface in a alone, and the next in b alone: the coverage
    std::uint64_t only_b = 0;
    std::uint64_t beyond = 0;     ///< of `both`, beyond CompareOptions' depth or normal
    DifferenceStatistics depth;   ///< over `both`, in the unit that depthUnit names
    DifferenceStatistics normal;  ///< over `both`, degrees between the decoded normals

    [[nodiscard]] std::uint64_t coverage() const { return only_a + only_b; }
    /// Shares in percent; 0 of nothing.
    [[nodiscard]] double coveragePercent() const;  ///< of `ends`
    [[nodiscard]] double beyondPercent() const;    ///< of `both`
    friend bool operator==(const EndDifference&, const EndDifference&) = default;
};

struct MapDifference {
    std::size_t index = 0;
    std::vector<Difference> structure;  ///< format, size, compare, decode, transform, flags
    /// Whether the texels were compared: format, width and height are the same. All below is 0 otherwise.
    bool compared = false;
    std::uint64_t texels = 0;            ///< of the map
    std::uint64_t texels_differing = 0;  ///< in any bit, also in those that no reader looks at
    EndDifference front;
    EndDifference back;  ///< of front-back maps
};

/// Where a surface may be, and which way it may look, without counting as `beyond`.
struct CompareOptions {
    double max_depth = 0.0;   ///< units of depthUnit
    double max_normal = 0.0;  ///< degrees
};

struct ColliderDifference {
    std::vector<Difference> structure;   ///< bounds, unit, number of maps
    std::vector<Difference> provenance;  ///< mesh and tool: where a collider comes from, not what it is
    std::vector<MapDifference> maps;     ///< of those that both have, in order: map i of a and map i of b
    EndDifference total;                 ///< both ends of all maps compared; depths in each map's own unit

    [[nodiscard]] bool structureDiffers() const;  ///< of the collider or of a map
    [[nodiscard]] bool texelsDiffer() const;      ///< in a bit
};

/// The step from one stored depth to the next: "1/65534" of the depth range of fixed point and, where
/// amounts may be fractions, of floats; "ulp" of halves.
[[nodiscard]] const char* depthUnit(MapFormat format);

/// Compares b with a. Of compare(b, a) only `a` and `b` of each Difference, and only_a and only_b, are
/// swapped. Takes up to 8 bytes of memory for each pair of surfaces that differ.
/// \param a, b  valid, as readContainer returns them.
[[nodiscard]] ColliderDifference compareColliders(const Collider& a, const Collider& b,
                                                  const CompareOptions& options = {});

}  // namespace relief
