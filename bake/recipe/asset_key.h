// A name for what an asset's output will be, known before it is baked: for caches of other programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bake/recipe/depfile.h"

namespace relief {

/// XXH3-128 of the program, the options and the inputs' names and contents: equal keys are equal outputs, byte for byte.
/// \param tool     toolIdentity()
/// \param options  RecipeJob::options
/// \param inputs   named from the recipe's folder, in any order.
[[nodiscard]] std::string assetKey(const std::string& tool, const std::vector<std::string>& options,
                                   std::vector<InputFile> inputs);

/// A file that a bake read, named from the recipe's folder; as it is if it lies elsewhere.
[[nodiscard]] std::string nameInRecipe(const std::filesystem::path& file,
                                       const std::filesystem::path& recipe_folder);

}  // namespace relief
