// The report of `relief diff` on two colliders, for people and as JSON.
#pragma once

#include <optional>
#include <string>

#include "formats/compare.h"

namespace relief {

/// By how much the fields of two files may differ. Either limit makes the fields count instead of the maps.
struct DiffLimits {
    std::optional<double> max_sides;  ///< percent of the points near the surfaces that may be on another side
    std::optional<double> max_distance;  ///< object units, for 99 % of the points near the surfaces
    bool strict_metadata = false;        ///< provenance counts
};

struct DiffSummary {
    std::string a;  ///< file names as in messages
    std::string b;
    std::string unit;  ///< of lengths; "" where none is known
    ColliderDifference difference;
    std::optional<FieldsDifference> fields;  ///< where the colliders differ
    DiffLimits limits;
    bool same_bytes = false;  ///< of the two files
};

/// The first reason why the difference is beyond the limits: "map 2: texels differ"; empty where it is within.
[[nodiscard]] std::string diffVerdict(const DiffSummary& summary);

[[nodiscard]] std::string diffText(const DiffSummary& summary);

/// formats/schemas/diff.schema.json.
[[nodiscard]] std::string diffJson(const DiffSummary& summary);

}  // namespace relief
