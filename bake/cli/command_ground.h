// `relief bake --heights`: a height map becomes a collider, or with --world a folder of tiles and the file that places them.
#pragma once

#include <string>

#include "bake/cli/command_world.h"
#include "formats/base/result.h"

namespace relief {

/// \param folder  of --world; empty without it.
/// Errors: those of settingsOf, HeightMap::open and bakeGroundOf; kUsage, kIo.
[[nodiscard]] Result<void> runGroundCommand(const std::string& folder, const WorldCall& call);

}  // namespace relief
