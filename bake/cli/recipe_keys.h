// `relief bake --recipe --dry-run --json`: the key of each asset, before anything is baked.
#pragma once

#include <vector>

#include "bake/recipe/recipe_run.h"
#include "formats/base/result.h"

namespace relief {

/// Gives keys to those that have none. Reads their meshes to that end, as far as other files belong to them. One whose mesh
/// or plan cannot be read gets none.
/// Errors: kIo: the program itself cannot be read.
[[nodiscard]] Result<void> addKeys(std::vector<AssetResult>& assets, const RecipeRun& run);

}  // namespace relief
