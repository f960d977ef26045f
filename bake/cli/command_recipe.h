// SPDX-License-Identifier: Apache-2.0
// The output options of `relief bake`, and the options of --recipe with their implementation.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/pipeline/bake_request.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/base/field.h"

namespace relief {

struct BakeOutputs {
    std::uint32_t compress = 0;
    bool json = false;
    std::string depfile;
};

void fields(FieldVisitor& visit, BakeOutputs& outputs);

/// Checks the files that a bake of one mesh reads and writes.
/// \param output  the value of -o. Errors: kUsage, kIo.
[[nodiscard]] Result<void> preflightBake(const BakeRequest& request, const std::string& output,
                                         const BakeOutputs& outputs, FileGuard& files);

struct BakeRecipeOptions {
    std::string recipe;
    std::string events;
    std::optional<Shard> shard;
    std::string stamp;
    bool dry_run = false;
};

/// Options that --recipe shares with a bake of one mesh.
struct RecipeCall {
    const CLI::App& verb;  ///< parsed
    const CommonOptions& common;
    const std::string& output;        ///< folder; empty: the recipe's folder
    std::optional<unsigned> threads;  ///< -j
    const std::string& depfile;
    bool json;
    FileGuard& files;
};

/// Returns the options of `relief bake` that a recipe may set.
[[nodiscard]] std::vector<RecipeKey> recipeKeys();

void addRecipeOptions(CLI::App& verb, BakeRecipeOptions& options);

/// Bakes the recipe's assets. If a signal interrupts it, the program ends by that signal.
/// Errors: those of the first failed asset in the recipe's order; kUsage, kIo.
[[nodiscard]] Result<void> runRecipeCommand(const BakeRecipeOptions& options, const RecipeCall& call);

}  // namespace relief
