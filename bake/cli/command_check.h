// SPDX-License-Identifier: Apache-2.0
// `relief check` of worlds and of ground; command_check.cpp checks colliders.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/pipeline/mesh_check.h"

namespace relief {

struct CheckCommand {
    CommonOptions common;
    std::vector<std::string> files;
    CheckRequest request;  ///< without a mesh, only the files are checked
    ContainerLimits limits;
    std::string heights;             ///< text of a HeightsSpec; empty: as recorded by the bake
    std::optional<float> within;     ///< world units
    std::optional<float> max_error;  ///< percent
    std::string html;                ///< the value of --page; empty: no page
    bool json = false;
};

/// Errors: those of loadWorld, checkWorld and makeWorldPage; kUsage; kDifference if max_error is exceeded.
[[nodiscard]] Result<void> runWorldCheck(const CheckCommand& command, const std::string& file,
                                         FileGuard& files);

/// Returns whether `relief check` reads the file of --mesh as a height map, even without --heights: standard input, or a
/// file whose extension belongs to no mesh format.
[[nodiscard]] bool isHeightMapFile(const std::string& file);

/// \param file  the container or the world
/// Errors: those of readColliderFile, loadWorld, recordedHeights and checkGround; kUsage; kUnsupported if --mesh has no
/// extension of a height map and the provenance records no --heights; kDifference if max_error is exceeded.
[[nodiscard]] Result<void> runGroundCheck(const CheckCommand& command, const std::string& file);

}  // namespace relief
