// SPDX-License-Identifier: Apache-2.0
// `relief bake --world` bakes a level into a folder of colliders and a file that places them. `relief check` measures
// the world.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bake/cli/command.h"
#include "bake/cli/command_recipe.h"
#include "bake/pipeline/bake_request.h"
#include "bake/pipeline/mesh_check.h"

namespace relief {

/// Options that --world and --heights share with a bake of one mesh.
struct WorldCall {
    const BakeRequest& request;
    const BakeOutputs& outputs;
    const CommonOptions& common;
    const std::string& output;  ///< -o; with --world it must be empty
    FileGuard& files;
};

/// Checks the files that a bake with --world reads and writes. Errors: kUsage, kIo.
[[nodiscard]] Result<void> preflightWorld(const std::filesystem::path& folder, const WorldCall& call);

void addWorldOption(CLI::App& verb, std::string& folder);

/// Errors: those of bakeWorld and of the first collider that failed; kUsage, kIo.
[[nodiscard]] Result<void> runWorldCommand(const std::string& folder, const WorldCall& call);

struct WorldCheckCall {
    const CheckRequest& request;  ///< without a mesh, only the files are checked
    std::optional<float> within;
    const ContainerLimits& limits;
    std::optional<float> max_error;  ///< percent
    const std::string& html;         ///< the value of --page; empty: no page
    bool json;
    FileGuard& files;
};

/// Errors: those of loadWorld, checkWorld and makeWorldPage; kUsage; kDifference if max_error is exceeded.
[[nodiscard]] Result<void> runWorldCheck(const std::string& file, const WorldCheckCall& call);

}  // namespace relief
