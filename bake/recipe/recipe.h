// SPDX-License-Identifier: Apache-2.0
// Recipes: TOML files that list many bakes. bake/recipe/README.md describes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "formats/fields/text.h"

namespace relief {

inline constexpr std::uint64_t kRecipeBytesMax = std::uint64_t{4} << 20;
inline constexpr std::size_t kRecipeTablesMax = 10'000;   ///< [[asset]] tables
inline constexpr std::size_t kRecipePatternsMax = 1'000;  ///< in a `mesh` or `exclude`

/// An option of `relief bake` that recipes may set, by its long name.
struct RecipeKey {
    std::string name;  ///< "max-error"
    FieldKind kind = FieldKind::kValue;
};

/// A position in a recipe: "FILE:LINE:COLUMN".
using RecipePlace = std::string;

struct RecipeValue {
    std::vector<std::string> values;  ///< for a flag, empty if it is off, and one "" if it is on
    RecipePlace place;
};

/// Sorted by name, so that the order in the file does not matter.
using RecipeOptions = std::map<std::string, RecipeValue>;

/// An [[asset]] merged with the defaults.
struct RecipeAsset {
    std::vector<std::string> meshes;   ///< patterns (glob.h), relative to the recipe's folder
    std::vector<std::string> exclude;  ///< patterns
    std::string output;                ///< may contain {stem}, {name}, {dir}; relative to the output folder
    bool optional = false;             ///< patterns without a match are allowed
    RecipeOptions options;
    RecipePlace place;
    RecipePlace mesh_place;
    RecipePlace output_place;

    /// Whether the asset bakes levels or height maps into worlds: the file name of `output` is kWorldFileName.
    [[nodiscard]] bool isWorld() const;
};

/// Parses a recipe.
/// \param keys  the options that may be set.
/// \param path  for messages.
/// Errors: kInvalidInput (invalid TOML, an unknown key, a wrong type, a missing value), kLimit. Messages start with
/// "FILE:LINE:COLUMN: ".
[[nodiscard]] Result<std::vector<RecipeAsset>> parseRecipe(std::string_view text,
                                                           const std::vector<RecipeKey>& keys,
                                                           const std::filesystem::path& path);

/// Loads a recipe file of at most kRecipeBytesMax. Errors: kIo, kLimit, those of parseRecipe.
[[nodiscard]] Result<std::vector<RecipeAsset>> loadRecipe(const std::filesystem::path& path,
                                                          const std::vector<RecipeKey>& keys);

/// Replaces options of `relief bake` in a message with keys of a recipe: "raise --timeout" becomes "raise timeout".
[[nodiscard]] std::string nameKeys(std::string message, const std::vector<RecipeKey>& keys);

/// Returns the options as sorted arguments of `relief bake`: --map=cube --prefer=inside.
[[nodiscard]] std::vector<std::string> recipeArguments(const RecipeOptions& options);

}  // namespace relief
