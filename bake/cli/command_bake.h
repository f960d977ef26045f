// SPDX-License-Identifier: Apache-2.0
// `relief bake` bakes one mesh; with --heights, a height map; with --world, a level or ground tiles into a folder; with
// --recipe, all assets that the recipe lists. Each of the four has its own source file.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/pipeline/bake_request.h"
#include "bake/recipe/depfile.h"
#include "bake/recipe/recipe_jobs.h"

namespace relief {

struct BakeOutputs {
    std::uint32_t compress = 0;
    bool json = false;
    std::string depfile;
};

void fields(FieldVisitor& visit, BakeOutputs& outputs);

struct BakeRecipeOptions {
    std::string recipe;
    std::string events;
    std::optional<Shard> shard;
    std::string stamp;
    bool dry_run = false;
};

struct BakeCommand {
    CommonOptions common;
    BakeRequest request;
    std::string output;  ///< -o; with --recipe a folder, with --world empty
    BakeOutputs outputs;
    BakeRecipeOptions recipe;
    std::string world;  ///< folder of --world; empty: a single collider
};

/// Checks the files that a bake into a single collider reads and writes. Errors: kUsage, kIo.
[[nodiscard]] Result<void> preflightBake(const BakeCommand& command, FileGuard& files);
/// Checks the files that a bake with --world reads and writes. Errors: kUsage, kIo.
[[nodiscard]] Result<void> preflightWorld(const BakeCommand& command, FileGuard& files);

/// Writes the file of --depfile if that option is set. Errors: those of writeDepfile.
[[nodiscard]] Result<void> writeDepfile(const BakeCommand& command, const std::string& target,
                                        const std::vector<InputFile>& inputs);
/// Prints a report: as JSON to standard output, or (unless --quiet is set) as text to standard error.
/// \param text  called only if the text is printed
[[nodiscard]] Result<void> printReport(const BakeCommand& command, FieldRef json,
                                       const std::function<std::string()>& text);

/// Returns the options that a recipe may set.
[[nodiscard]] std::vector<RecipeKey> recipeKeys();

void addRecipeOptions(CLI::App& verb, BakeRecipeOptions& options);

/// Bakes the recipe's assets. If a signal interrupts the run, the program ends by that signal. \param verb  parsed
/// Errors: those of the first failed asset in the recipe's order; kUsage, kIo.
[[nodiscard]] Result<void> runRecipeCommand(const BakeCommand& command, const CLI::App& verb,
                                            FileGuard& files);

/// Errors: those of bakeWorld and of the first collider that failed; kUsage, kIo.
[[nodiscard]] Result<void> runWorldCommand(const BakeCommand& command, FileGuard& files);

/// Errors: those of settingsOf, HeightMap::open and bakeHeightMap; kUsage, kIo.
[[nodiscard]] Result<void> runGroundCommand(const BakeCommand& command, FileGuard& files);

}  // namespace relief
