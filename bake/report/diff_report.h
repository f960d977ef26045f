// What `relief diff` says of two colliders, for people and as JSON.
#pragma once

#include <optional>
#include <string>

#include "formats/compare.h"
#include "formats/compare_fields.h"

namespace relief {

/// What two files may differ in without that being a difference, percent of each map and of both its ends.
struct DiffLimits {
    CompareOptions surface;        ///< of a surface that both have: more than this is beyond
    double max_coverage = 0.0;     ///< share of ends that have a surface in one file alone
    double max_texels = 0.0;       ///< share of the surfaces of both that may be beyond `surface`
    bool strict_metadata = false;  ///< provenance counts
    /// Of the fields. Either makes them count instead of the maps, and all above but strict_metadata not.
    std::optional<double> max_sides;  ///< percent of the points near the surfaces that may be on another side
    std::optional<double> max_distance;  ///< object units, for 99 % of the points near the surfaces

    [[nodiscard]] bool ofFields() const { return max_sides || max_distance; }
};

struct DiffSummary {
    std::string a;  ///< file names as in messages
    std::string b;
    const Collider& collider_a;
    const ColliderDifference& difference;
    const std::optional<FieldsDifference>&
        fields;  ///< where maps differ in more than texels, or limits are of fields
    const DiffLimits& limits;
    bool same_bytes = false;  ///< of the two files
};

/// The first reason why the difference is beyond the limits: "map 2: 1.5 % of …"; empty where it is within.
[[nodiscard]] std::string diffVerdict(const ColliderDifference& difference,
                                      const std::optional<FieldsDifference>& fields,
                                      const DiffLimits& limits);

[[nodiscard]] std::string diffText(const DiffSummary& summary);

/// a, b: file names. identical: the same bytes. same_collider: the same texels, frames, bounds and unit.
/// within_limits; limits {max_coverage, max_depth, max_normal, max_texels, strict_metadata, max_sides, max_distance}.
/// structure, provenance: [{what, a, b}]. maps: [{index, structure, compared, depth_unit, texels,
/// texels_differing, front, back}], `back` null but for front-back maps, depth_unit to back null unless
/// compared; total: an end. An end: {ends, both, only_a, only_b, coverage_percent, beyond, beyond_percent,
/// depth, normal_degrees}, the last two {differing, max, mean, percentile_99}.
/// fields: null, or {box, near}, each {points, only_a, only_b, sides_percent, distances, one_known, distance}.
[[nodiscard]] std::string diffJson(const DiffSummary& summary);

}  // namespace relief
