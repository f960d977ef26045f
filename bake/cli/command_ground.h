// SPDX-License-Identifier: Apache-2.0
// `relief bake --heights`: a height map becomes a collider, or with --world a folder of tiles and the file that places them.
// `relief check` of either against the height map.
#pragma once

#include <string>

#include "bake/cli/command_world.h"
#include "formats/base/result.h"

namespace relief {

/// \param folder  of --world; empty without it.
/// Errors: those of settingsOf, HeightMap::open and bakeGroundOf; kUsage, kIo.
[[nodiscard]] Result<void> runGroundCommand(const std::string& folder, const WorldCall& call);

/// Whether `relief check` takes the file of --mesh for a height map without --heights: a file, or standard input, whose extension
/// is that of no mesh format.
[[nodiscard]] bool namesHeightMap(const std::string& file);

struct GroundCheckCall {
    const WorldCheckCall& world;  ///< what a check of a world takes, of a collider too
    const std::string& heights;   ///< HeightsSpec; empty: those that the ground was baked with
    bool quiet;
};

/// \param file  the container or the world.
/// Errors: those of readColliderFile, loadWorld, recordedHeights and checkGround; kUsage; kUnsupported: neither a height map by its
/// extension nor by what the ground records; kDifference: more than max_error.
[[nodiscard]] Result<void> runGroundCheck(const std::string& file, const GroundCheckCall& call);

}  // namespace relief
