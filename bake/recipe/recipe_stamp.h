// What a build system needs of a recipe's run: a stamp that stands for all outputs, and what they depend on.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bake/recipe/recipe_run.h"
#include "formats/base/result.h"

namespace relief {

/// Writes which files all outputs were made from: the recipe, every input, and every folder that a pattern
/// looked through, so that a new file is noticed. A folder that the run itself writes into is left out: its
/// time changes by that alone. \param stamp    the target; empty: all outputs are. \param beside   further
/// files that the run writes; empty names are none. \param folders  that patterns looked through. Errors:
/// those of writeDepfile.
[[nodiscard]] Result<void> writeRecipeDepfile(const std::filesystem::path& path, const std::string& stamp,
                                              const std::vector<std::string>& beside, const RecipeRun& run,
                                              const std::vector<std::filesystem::path>& folders,
                                              const std::vector<AssetResult>& assets);

/// A line "HASH  OUTPUT" for each asset: the same outputs give the same bytes. Errors: kIo.
[[nodiscard]] Result<void> writeRecipeStamp(const std::filesystem::path& path,
                                            const std::vector<AssetResult>& assets);

}  // namespace relief
