// relief bake --recipe: the options, and what they do.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "bake/recipe/recipe_jobs.h"

namespace relief {

struct RecipeOptionsOfBake {
    std::string recipe;
    std::string events;
    std::optional<Shard> shard;
    std::string stamp;
    std::string root;         ///< a folder; empty: none
    float timeout = 3600.0F;  ///< seconds for one asset; 0: any
    bool fail_fast = false;
    bool dry_run = false;
};

/// Options that --recipe shares with a bake of one mesh.
struct RecipeCall {
    const CLI::App& verb;  ///< parsed
    const CommonOptions& common;
    const std::string& output;        ///< a folder; empty: the recipe's
    std::optional<unsigned> threads;  ///< -j
    const std::string& depfile;
    bool json;
    FileGuard& files;
};

/// The options of `relief bake` that a recipe may set.
[[nodiscard]] std::vector<RecipeKey> recipeKeys();

void addRecipeOptions(CLI::App& verb, RecipeOptionsOfBake& options);

/// Bakes the recipe's assets. Ends the program by the signal that interrupted it.
/// Errors: those of the first asset in the recipe's order that failed; kUsage, kIo.
[[nodiscard]] Result<void> runRecipeCommand(const RecipeOptionsOfBake& options, const RecipeCall& call);

}  // namespace relief
