// SPDX-License-Identifier: Apache-2.0
// `relief bake --heights` bakes a height map into a collider, or with --world into a folder of tiles and a file that
// places them. `relief check` measures either against the height map.
#pragma once

#include <string>

#include "bake/cli/command_world.h"
#include "formats/base/result.h"

namespace relief {

/// \param folder  the value of --world, or empty
/// Errors: those of settingsOf, HeightMap::open and bakeGroundOf; kUsage, kIo.
[[nodiscard]] Result<void> runGroundCommand(const std::string& folder, const WorldCall& call);

/// Returns whether `relief check` reads the file of --mesh as a height map without --heights: standard input or a file
/// whose extension is not that of a mesh format.
[[nodiscard]] bool namesHeightMap(const std::string& file);

struct GroundCheckCall {
    const WorldCheckCall& world;  ///< options of a check of a world or a collider
    const std::string& heights;   ///< HeightsSpec; empty: the settings of the bake
    bool quiet;
};

/// \param file  the container or the world
/// Errors: those of readColliderFile, loadWorld, recordedHeights and checkGround; kUsage; kUnsupported if neither the
/// extension of --mesh nor the record of the ground names a height map; kDifference if max_error is exceeded.
[[nodiscard]] Result<void> runGroundCheck(const std::string& file, const GroundCheckCall& call);

}  // namespace relief
