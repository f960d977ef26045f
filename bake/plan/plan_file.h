// Plan files: the maps of a bake as TOML, for people to read and to change. `relief bake --plan-out` writes
// them, `relief bake --plan` bakes from them.
//
//     version = 1
//     quality = "normal"
//     prefer = "neither"
//     budget = 1000000
//     thickness = 0.009
//
//     # both sides along (0, 0, 1) see 83.1 % of the surface; service +71.4 %
//     [[map]]
//     format = "front-back"
//     dir = "+z"
//     size = "180x178"
//     depth = "unorm16"
//     decode = "plane"
//     box = "tight"
//
// `budget` is what the maps were planned for, bytes on the GPU; it changes nothing but the collider's record, and may be
// left out. `thickness` is the default from which each shell takes what suits its part (bake/shape/thickness.h), in the mesh's
// units; without it the bake takes its own. A map has `format`, `size`, and whichever other keys of map_spec.h it needs; their values are strings, as
// after --map, and `size` may be a whole number. Numbers are the shortest that read back as the same floats:
// what was planned and what is baked from its file are the same bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bake/plan/map_spec.h"
#include "bake/plan/prefer.h"
#include "formats/base/result.h"

namespace relief {

struct PlanFileMap {
    MapSpec spec;         ///< with a size
    std::string comment;  ///< why this map; written as a comment of one line, and not read back
};

struct PlanFile {
    Quality quality = Quality::kNormal;
    Prefer prefer = Prefer::kNeither;
    std::uint64_t budget = 0;  ///< bytes; 0: none is named
    double thickness = 0.0;    ///< of shells, before their parts bound it; 0: none is named
    std::vector<PlanFileMap> maps;
};

/// Parsing it gives the same quality, prefer, budget, thickness and specs.
[[nodiscard]] std::string planText(const PlanFile& plan);

/// \param path  for messages.
/// Errors: kInvalidInput (no TOML, an unknown key, a wrong value, no map), kLimit (a size, too many maps).
/// Messages start with "FILE:LINE:COLUMN: ".
[[nodiscard]] Result<PlanFile> parsePlan(std::string_view text, const std::filesystem::path& path);

/// Reads a file of at most 1 MiB. Errors: kIo, kLimit, those of parsePlan.
[[nodiscard]] Result<PlanFile> loadPlan(const std::filesystem::path& path);

}  // namespace relief
