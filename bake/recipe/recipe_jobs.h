// SPDX-License-Identifier: Apache-2.0
// The bakes of a recipe, file by file: patterns matched, outputs named, and none that would overwrite an input or another
// output.
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
/// The extension of every collider.
inline constexpr std::string_view kColliderExtension = ".relief";
/// Beside the outputs: the inputs of each.
inline constexpr const char* kBakeCacheName = ".relief-cache.json";
/// Beside the containers of a level: how their errors grow with fewer bytes.
inline constexpr const char* kErrorCurvesName = ".relief-curves.json";

/// In RecipeJob::options of a world.
inline constexpr const char* kWorldOption = "--world";

/// One mesh to be baked into one collider, or one level or height map into a world.
struct RecipeJob {
    std::string mesh;                    ///< from the recipe's folder
    std::filesystem::path mesh_path;     ///< ready to be opened
    std::string output;                  ///< from the output folder, without `.` and `..`
    std::filesystem::path output_path;   ///< ready to be written; its folder may be missing
    bool mesh_is_folder = false;         ///< a level of the mesh files in it
    bool world = false;                  ///< `output` is a world's file, and the folder of that is its alone
    std::vector<std::string> arguments;  ///< of `relief bake`, files as they can be opened; sorted
    std::vector<std::string> options;    ///< the same, files from the recipe's folder, and kWorldOption: the
                                         ///< output depends on them
};

struct RecipeJobs {
    std::vector<RecipeJob> jobs;                 ///< in the order of the recipe
    std::vector<std::filesystem::path> folders;  ///< that patterns looked through; each once
    FileGuard files;                             ///< holds every input and every output
};

/// \param recipe  meshes are named from its folder and may not lie outside of it; "-": the current one.
/// \param output_folder  need not exist; empty for the recipe's folder.
/// \param files  holds what else is read. Errors, at a place of
/// the recipe: kInvalidInput (a pattern that matches nothing, a file outside of the recipe's folder, an
/// output outside of the output folder, neither a collider nor a world, the same as another output or as an
/// input, or in the folder of another world), kLimit (kRecipeJobsMax), those of globFiles.
[[nodiscard]] Result<RecipeJobs> recipeJobs(const std::vector<RecipeAsset>& assets,
                                            const std::filesystem::path& recipe,
                                            const std::filesystem::path& output_folder, FileGuard files = {});

/// The bake of a world owns its folder's containers, also those that are up to date, and its caches.
/// \param option  that names the folder. Errors: as FileGuard::writes().
[[nodiscard]] Result<void> ownWorldFolder(const std::filesystem::path& folder, std::string_view option,
                                          FileGuard& files);

/// The folder of a recipe: never empty.
[[nodiscard]] std::filesystem::path recipeFolder(const std::filesystem::path& recipe);

/// One of several runs that share a recipe.
struct Shard {
    std::uint64_t index = 1;  ///< 1 to count
    std::uint64_t count = 1;
};

/// Whether an output belongs to this shard: every output belongs to exactly one of `count` shards, by its name alone (XXH3-64
/// modulo count).
[[nodiscard]] bool inShard(const std::string& output, const Shard& shard);

}  // namespace relief
