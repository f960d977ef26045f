// SPDX-License-Identifier: Apache-2.0
// Bakes the stale assets of a recipe, each in its own process, so that a crash, a hang or a lack of memory affects only
// that asset.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bake/recipe/bake_cache.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/base/result.h"
#include "formats/fields/field.h"

namespace relief {

enum class AssetState : std::uint8_t {
    kStale,  ///< to be baked
    kUpToDate,
    kBaked,     ///< its output is new
    kFailed,    ///< its output is unchanged
    kCanceled,  ///< not started or not finished before the run ended
};
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<AssetState>{"stale", "up_to_date", "baked",
                                                                      "failed", "canceled"};

struct AssetResult {
    RecipeJob job;
    AssetState state = AssetState::kStale;
    std::string reason;       ///< why it was stale; "" if up to date
    double ms = 0.0;          ///< duration of the bake
    std::string hash;         ///< XXH3-128 of the output, if baked or up to date
    std::uint64_t bytes = 0;  ///< of the output with its containers, if baked or up to date
    /// The containers of a world, relative to the output folder, if baked or up to date.
    std::vector<std::string> containers;
    /// Misclassified points near the surface; for a world, those of its worst collider.
    std::optional<double> wrong_percent;
    Error error;                        ///< if failed
    std::vector<std::string> warnings;  ///< from its bake
    std::vector<InputFile> inputs;      ///< relative to the recipe's folder, the mesh first; set if `hash` is
    std::string key;                    ///< assetKey(); set if `inputs` is
};

struct RecipeRun {
    std::filesystem::path recipe;
    std::filesystem::path output_folder;  ///< exists, unless dry_run
    std::vector<RecipeKey> keys;          ///< of recipes, for nameKeys()
    unsigned jobs = 1;                    ///< at least 1
    unsigned threads = 1;                 ///< per bake; results do not depend on `jobs` or `threads`
    bool dry_run = false;                 ///< only determines what is stale
    // Called on the thread of runRecipe(); may be empty.
    std::function<void(const AssetResult&)> started;
    std::function<void(const AssetResult&)> ended;  ///< up to date, baked, failed or canceled
    std::function<void(const std::string&)> warn;
};

struct RecipeResult {
    std::vector<AssetResult> assets;  ///< in the order of the recipe
    int signal = 0;                   ///< signal that ended the run early; its children have ended. 0: none
};

/// Runs the jobs. Errors of single assets are in their results.
/// Errors: kIo (the program's own file cannot be read, or the cache file cannot be written), kUsage (an output that is
/// not in the cache would replace a file of another format).
[[nodiscard]] Result<RecipeResult> runRecipe(std::vector<RecipeJob> jobs, const RecipeRun& run);

/// Writes a depfile for build systems with the inputs of all outputs: the recipe, every file read, and every folder
/// that a pattern searched, so that new files are noticed. Omits folders that the run itself writes to, because writing
/// changes their modification time.
/// \param stamp    the target; empty: all outputs are targets
/// \param beside   other files that the run writes; empty names are ignored
/// \param folders  folders that patterns searched
/// Errors: those of writeDepfile.
[[nodiscard]] Result<void> writeRecipeDepfile(const std::filesystem::path& path, const std::string& stamp,
                                              const std::vector<std::string>& beside, const RecipeRun& run,
                                              const std::vector<std::filesystem::path>& folders,
                                              const std::vector<AssetResult>& assets);

/// Writes a line "HASH  OUTPUT" per asset; equal outputs give identical bytes. Errors: kIo.
[[nodiscard]] Result<void> writeRecipeStamp(const std::filesystem::path& path,
                                            const std::vector<AssetResult>& assets);

}  // namespace relief
