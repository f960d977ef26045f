// SPDX-License-Identifier: Apache-2.0
// Bakes the stale assets of a recipe: each by a process of its own, so that one that crashes, hangs or takes all memory
// fails alone.
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
    kBaked,      ///< its output is new
    kFailed,     ///< its output is as it was
    kCancelled,  ///< not begun, or not finished, because the run ended before
};
template <>
inline constexpr std::array<std::string_view, 5> kWordsOf<AssetState>{"stale", "up to date", "baked",
                                                                      "failed", "cancelled"};

struct AssetResult {
    RecipeJob job;
    AssetState state = AssetState::kStale;
    std::string reason;                   ///< why it was to be baked; "" if up to date
    double ms = 0.0;                      ///< time of its bake
    std::string hash;                     ///< XXH3-128 of the output; baked or up to date
    std::uint64_t bytes = 0;              ///< of the output, with the containers; baked or up to date
    std::vector<std::string> containers;  ///< of a world, from the output folder; baked or up to date
    std::optional<double> wrong_percent;  ///< points near the surface; of a world those of its worst collider
    Error error;                          ///< failed
    std::vector<std::string> warnings;    ///< of its baking
    std::vector<InputFile> inputs;        ///< from the recipe's folder, the mesh first; known as the hash is
    std::string key;                      ///< assetKey(); known as the inputs are
};

struct RecipeRun {
    std::filesystem::path recipe;
    std::filesystem::path output_folder;  ///< exists, unless dry_run
    unsigned at_once = 1;                 ///< at least 1
    unsigned threads = 1;                 ///< of each bake; results do not depend on either
    bool dry_run = false;                 ///< only find out what is to be done
    // Called between the work; may be empty.
    std::function<void(const AssetResult&)> started;
    std::function<void(const AssetResult&)> ended;  ///< up to date, baked, failed or cancelled
    std::function<void(const std::string&)> warn;
};

struct RecipeResult {
    std::vector<AssetResult> assets;  ///< in the order of the recipe
    int signal = 0;                   ///< that ended the run early; its children are gone
};

/// Errors: kIo: the program itself cannot be read, or the cache file not written; kUsage: an output would replace a file that is
/// neither known nor of its kind. Errors of single assets are in their
/// results.
[[nodiscard]] Result<RecipeResult> runRecipe(std::vector<RecipeJob> jobs, const RecipeRun& run);

/// For build systems: the inputs of all outputs, which are the recipe, every file read, and every folder that a pattern
/// looked through, so that a new file is noticed. A folder that the run itself writes into is left out: its
/// time changes by that alone.
/// \param stamp    the target; empty: all outputs are
/// \param beside   further files that the run writes; empty names are none
/// \param folders  that patterns looked through
/// Errors: those of writeDepfile.
[[nodiscard]] Result<void> writeRecipeDepfile(const std::filesystem::path& path, const std::string& stamp,
                                              const std::vector<std::string>& beside, const RecipeRun& run,
                                              const std::vector<std::filesystem::path>& folders,
                                              const std::vector<AssetResult>& assets);

/// A line "HASH  OUTPUT" for each asset: the same outputs give the same bytes. Errors: kIo.
[[nodiscard]] Result<void> writeRecipeStamp(const std::filesystem::path& path,
                                            const std::vector<AssetResult>& assets);

}  // namespace relief
