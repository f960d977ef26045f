// SPDX-License-Identifier: Apache-2.0
// Recipes: many bakes in one TOML file, for people to write. bake/recipe/README.md is the normative
// description.
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
inline constexpr std::size_t kRecipeTablesMax = 10'000;   ///< [[asset]]
inline constexpr std::size_t kRecipePatternsMax = 1'000;  ///< of one `mesh` or `exclude`

/// An option of `relief bake` that a recipe may set, by its long name.
struct RecipeKey {
    std::string name;  ///< "max-error"
    FieldKind kind = FieldKind::kValue;
};

/// A place in a recipe: "FILE:LINE:COLUMN".
using RecipePlace = std::string;

struct RecipeValue {
    std::vector<std::string> values;  ///< of a flag: none if it is off, "" if it is on
    RecipePlace place;
};

/// Sorted by name, so that the same options are the same list whatever their order in the file.
using RecipeOptions = std::map<std::string, RecipeValue>;

/// One [[asset]], the defaults merged in.
struct RecipeAsset {
    std::vector<std::string> meshes;   ///< patterns (glob.h), from the recipe's folder
    std::vector<std::string> exclude;  ///< patterns
    std::string output;                ///< {stem}, {name}, {dir}; from the output folder
    bool optional = false;             ///< a pattern may match nothing
    RecipeOptions options;
    RecipePlace place;
    RecipePlace mesh_place;
    RecipePlace output_place;

    /// Whether it bakes levels or height maps into worlds: `output` names their kWorldFileName.
    [[nodiscard]] bool isWorld() const;
};

/// \param keys  the options that may be set.
/// \param path  for messages.
/// Errors: kInvalidInput (no TOML, an unknown key, a wrong type, what is missing), kLimit. Messages start
/// with "FILE:LINE:COLUMN: ".
[[nodiscard]] Result<std::vector<RecipeAsset>> parseRecipe(std::string_view text,
                                                           const std::vector<RecipeKey>& keys,
                                                           const std::filesystem::path& path);

/// Reads a file of at most kRecipeBytesMax. Errors: kIo, kLimit, those of parseRecipe.
[[nodiscard]] Result<std::vector<RecipeAsset>> loadRecipe(const std::filesystem::path& path,
                                                          const std::vector<RecipeKey>& keys);

/// The options as arguments of `relief bake`, sorted: --map=cube --prefer=inside.
[[nodiscard]] std::vector<std::string> recipeArguments(const RecipeOptions& options);

}  // namespace relief
