// SPDX-License-Identifier: Apache-2.0
// The inputs of each output of a recipe, so that only stale outputs are baked again.
//
// An entry records hashes of inputs and of their output, the options and the program. Baking is deterministic, so an
// entry that matches the present files proves that the output is right, whoever wrote it, and one that does not match
// only costs a bake. Contents are always hashed; times are never compared.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bake/recipe/depfile.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/base/result.h"

namespace relief {

struct BakeCacheEntry {
    std::string tool;                  ///< toolIdentity()
    std::vector<std::string> options;  ///< RecipeJob::options
    std::vector<InputFile> inputs;     ///< from the recipe's folder; the mesh first
    std::string output_hash;           ///< XXH3-128
    std::uint64_t output_bytes = 0;    ///< with the containers
    /// Of a world: the XXH3-128 of its containers, by their names in its folder.
    std::map<std::string, std::string> containers = {};
    std::optional<double> wrong_percent = {};  ///< as its bake measured it

    bool operator==(const BakeCacheEntry&) const = default;
};

/// By the output's name.
using BakeCacheEntries = std::map<std::string, BakeCacheEntry>;

/// "relief 0.1.0 HASH": another build is another tool. Errors: kIo.
[[nodiscard]] Result<std::string> toolIdentity();

/// XXH3-128 of a regular file's bytes; nullopt for anything else, or what cannot be read.
[[nodiscard]] std::optional<std::string> hashOfFile(const std::filesystem::path& path);

/// The same of an input; of a folder that of the names in it, but for those that start with a dot or that bakes write.
[[nodiscard]] std::optional<std::string> hashOfInput(const std::filesystem::path& path);

/// The entries of a cache file's text. Errors: kInvalidInput: no cache file of this version.
[[nodiscard]] Result<BakeCacheEntries> parseBakeCache(std::string_view text);
[[nodiscard]] std::string bakeCacheText(const BakeCacheEntries& entries);

/// The cache file in an output folder; none is no error. A symbolic link in its place is not followed, and replaced by the
/// next update. Errors, all with the file in front: kInvalidInput, kIo, kLimit.
[[nodiscard]] Result<BakeCacheEntries> loadBakeCache(const std::filesystem::path& output_folder);

/// Adds entries to the cache file, beside those that other runs have added meanwhile; entries of outputs
/// that are gone are left out. Safe against any number of processes at once: the folder is locked (flock)
/// meanwhile. Where it cannot be locked, entries may get lost, which costs a bake. Errors: kIo.
[[nodiscard]] Result<void> updateBakeCache(const std::filesystem::path& output_folder,
                                           const BakeCacheEntries& entries);

/// XXH3-128 of the program, the options and the inputs' names and contents: equal keys are equal outputs, byte for byte.
/// For caches of other programs. \param tool  toolIdentity(). \param options  RecipeJob::options.
/// \param inputs  named from the recipe's folder, in any order.
[[nodiscard]] std::string assetKey(const std::string& tool, const std::vector<std::string>& options,
                                   std::vector<InputFile> inputs);

/// A file that a bake read, named from the recipe's folder; as it is if it lies elsewhere.
[[nodiscard]] std::string nameInRecipe(const std::filesystem::path& file,
                                       const std::filesystem::path& recipe_folder);

/// The reason why a job is stale, in a few words; nullopt if its output is up to date.
/// \param entry  null if there is none.
/// \param recipe_folder  where the names of inputs start.
[[nodiscard]] std::optional<std::string> staleness(const RecipeJob& job, const BakeCacheEntry* entry,
                                                   const std::string& tool,
                                                   const std::filesystem::path& recipe_folder);

}  // namespace relief
