// SPDX-License-Identifier: Apache-2.0
// Expands a recipe into single bakes: matches patterns, names outputs, and rejects outputs that would overwrite an
// input or another output.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "bake/recipe/recipe.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"

namespace relief {

inline constexpr std::size_t kRecipeJobsMax = 100'000;
/// The file extension of colliders.
inline constexpr std::string_view kColliderExtension = ".relief";
/// Cache file next to the outputs: the inputs of each output.
inline constexpr const char* kBakeCacheName = ".relief-cache.json";
/// Cache file next to the containers of a level: their errors as functions of their bytes.
inline constexpr const char* kErrorCurvesName = ".relief-curves.json";

/// Option that marks the RecipeJob::options of a world.
inline constexpr const char* kWorldOption = "--world";

/// A bake of one mesh into a collider, or of a level or height map into a world.
struct RecipeJob {
    std::string mesh;                    ///< relative to the recipe's folder
    std::filesystem::path mesh_path;     ///< can be opened from the current folder
    std::string output;                  ///< relative to the output folder, without `.` and `..`
    std::filesystem::path output_path;   ///< can be opened from the current folder; its folder may be missing
    bool mesh_is_folder = false;         ///< the mesh is a folder whose mesh files form a level
    bool world = false;                  ///< `output` is a world's file, and the only output in its folder
    std::vector<std::string> arguments;  ///< of `relief bake`, files relative to the current folder; sorted
    /// The options that the output depends on: `arguments`, with files relative to the recipe's folder, and for a world
    /// kWorldOption.
    std::vector<std::string> options;
};

struct RecipeJobs {
    std::vector<RecipeJob> jobs;                 ///< in the order of the recipe
    std::vector<std::filesystem::path> folders;  ///< folders that patterns searched; without duplicates
    FileGuard files;                             ///< contains every input and every output
};

/// Expands the assets of a recipe.
/// \param recipe  path of the recipe; its folder must contain all meshes; "-": the current folder.
/// \param output_folder  need not exist; empty for the recipe's folder.
/// \param files  already contains all other inputs.
/// Errors, with a position in the recipe: kInvalidInput (a pattern without a match, a file outside the recipe's folder,
/// an output that is outside the output folder, is in the folder of another world, equals another output or an input,
/// or is neither a collider nor a world), kLimit (kRecipeJobsMax), those of globFiles.
[[nodiscard]] Result<RecipeJobs> recipeJobs(const std::vector<RecipeAsset>& assets,
                                            const std::filesystem::path& recipe,
                                            const std::filesystem::path& output_folder, FileGuard files = {});

/// Registers the outputs in the folder of a world: all present and future containers, and the cache files.
/// \param option  the option that names the folder, for messages. Errors: those of FileGuard::writes().
[[nodiscard]] Result<void> reserveWorldFolder(const std::filesystem::path& folder, std::string_view option,
                                              FileGuard& files);

/// Returns the folder of a recipe; never empty.
[[nodiscard]] std::filesystem::path recipeFolder(const std::filesystem::path& recipe);

/// One of several runs that share a recipe.
struct Shard {
    std::uint64_t index = 1;  ///< 1 to count
    std::uint64_t count = 1;
};

/// Whether an output belongs to a shard. Every output belongs to exactly one of `count` shards, determined only by its
/// name (XXH3-64 modulo count).
[[nodiscard]] bool inShard(const std::string& output, const Shard& shard);

}  // namespace relief
