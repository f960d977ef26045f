// SPDX-License-Identifier: Apache-2.0
// Plan files: the maps of a bake as TOML, to read and to edit. `relief bake --plan-out` writes them, `relief bake --plan`
// bakes from them.
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
// `budget`, optional, is the number of bytes on the GPU that the maps were planned for, for the collider's record alone.
// `thickness`, optional, is the default from which each shell derives its own (bake/shape/thickness.h), in the mesh's units.
// A map has `format`, `size`, or `bytes` of patches, and other keys of map_spec.h, with strings as after --map; `size` and
// `bytes` may be whole numbers. Numbers are the shortest that read back as the same floats: a plan and its file bake to the
// same bytes.
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
    std::string comment;  ///< why this map: one line, which is not read back
};

struct PlanFile {
    Quality quality = Quality::kNormal;
    Prefer prefer = Prefer::kNeither;
    std::uint64_t budget = 0;  ///< bytes; 0: none
    double thickness = 0.0;    ///< default of shells, before their parts bound it; 0: none
    std::vector<PlanFileMap> maps;
};

/// parsePlan() reads it back, but for the comments.
[[nodiscard]] std::string planText(const PlanFile& plan);

/// \param path  for messages.
/// Errors: kInvalidInput (no TOML, an unknown key, a wrong value, no map), kLimit (a size, too many maps).
/// Messages start with "FILE:LINE:COLUMN: ".
[[nodiscard]] Result<PlanFile> parsePlan(std::string_view text, const std::filesystem::path& path);

/// Reads a file of at most 1 MiB. Errors: kIo, kLimit, those of parsePlan.
[[nodiscard]] Result<PlanFile> loadPlan(const std::filesystem::path& path);

}  // namespace relief
