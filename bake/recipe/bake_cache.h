// SPDX-License-Identifier: Apache-2.0
// Records the inputs of each output of a recipe, so that only stale outputs are baked again.
//
// An entry records the program, the options, and the hashes of the inputs and the output. Baking is deterministic: if
// an entry matches the current files, the output is correct, no matter who wrote the entry. A wrong entry costs only
// one bake. Contents are always hashed; times are never compared.
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
    std::vector<InputFile> inputs;     ///< relative to the recipe's folder; the mesh first
    std::string output_hash;           ///< XXH3-128
    std::uint64_t output_bytes = 0;    ///< including the containers of a world
    /// For a world: the XXH3-128 of its containers, by their names in its folder.
    std::map<std::string, std::string> containers = {};
    std::optional<double> wrong_percent = {};  ///< as measured by its bake

    bool operator==(const BakeCacheEntry&) const = default;
};

/// Entries by the name of the output.
using BakeCacheEntries = std::map<std::string, BakeCacheEntry>;

/// Returns "relief 0.1.0 HASH HASH": hashes of this program and, if it exists, of relief-import beside it. Errors: kIo.
[[nodiscard]] Result<std::string> toolIdentity();

/// Returns the XXH3-128 of a regular file; nullopt for anything else, or if it cannot be read.
[[nodiscard]] std::optional<std::string> hashOfFile(const std::filesystem::path& path);

/// Returns the hash of an input. For a folder, hashes the names in it, except .*, *.relief and world.json.
[[nodiscard]] std::optional<std::string> hashOfInput(const std::filesystem::path& path);

/// Reads a cache file; nullopt if there is none. Does not follow a symbolic link at `path`.
/// Errors: kInvalidInput (not a regular file), kIo, kLimit.
[[nodiscard]] Result<std::optional<std::vector<std::byte>>> readCacheFile(const std::filesystem::path& path);
/// Replaces a cache file, or a symbolic link at `path`. Errors: kIo.
[[nodiscard]] Result<void> writeCacheFile(const std::filesystem::path& path, std::string_view text);

/// Parses the text of a cache file. Errors: kInvalidInput (not a cache file of this version).
[[nodiscard]] Result<BakeCacheEntries> parseBakeCache(std::string_view text);
[[nodiscard]] std::string bakeCacheText(const BakeCacheEntries& entries);

/// Loads the cache file of an output folder; empty if there is none. Does not follow a symbolic link at its path; the
/// next update replaces the link.
/// Errors, prefixed with the file: kInvalidInput, kIo, kLimit.
[[nodiscard]] Result<BakeCacheEntries> loadBakeCache(const std::filesystem::path& output_folder);

/// Adds entries to the cache file, preserving entries that other runs have added in the meantime. Removes entries whose
/// output is gone. Safe for any number of concurrent processes, because the folder is locked (flock). If it cannot be
/// locked, entries may be lost, and their outputs are baked again. Errors: kIo.
[[nodiscard]] Result<void> updateBakeCache(const std::filesystem::path& output_folder,
                                           const BakeCacheEntries& entries);

/// Returns the XXH3-128 of the program, the options, and the names and contents of the inputs. Equal keys mean
/// byte-identical outputs. Other programs can use the key for their own caches.
/// \param tool  toolIdentity(). \param options  RecipeJob::options.
/// \param inputs  named relative to the recipe's folder, in any order.
[[nodiscard]] std::string assetKey(const std::string& tool, const std::vector<std::string>& options,
                                   std::vector<InputFile> inputs);

/// Returns the path of a file relative to the recipe's folder, or the unchanged path if there is no relative one.
[[nodiscard]] std::string pathFromRecipe(const std::filesystem::path& file,
                                         const std::filesystem::path& recipe_folder);

/// Returns why a job is stale, in a few words; nullopt if its output is up to date.
/// \param entry  null if there is none.
/// \param recipe_folder  the names of inputs are relative to this folder.
[[nodiscard]] std::optional<std::string> staleness(const RecipeJob& job, const BakeCacheEntry* entry,
                                                   const std::string& tool,
                                                   const std::filesystem::path& recipe_folder);

}  // namespace relief
