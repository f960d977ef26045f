// Removes what a recipe has baked and no longer names: its mesh is gone, excluded, or baked under another name.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "formats/base/result.h"

namespace relief {

struct PrunedOutput {
    std::string output;       ///< from the output folder
    std::string mesh;         ///< that it was baked from, from the recipe's folder
    std::uint64_t bytes = 0;  ///< of the file
    std::string kept = {};    ///< why it stays; empty: it was removed, or would be
};

/// Removes the outputs that the cache records as baked by this recipe, and their entries. A file stays that is not what
/// the recipe wrote, byte for byte, or that a symbolic link leads to.
/// \param recipe   recipeName(); empty: nothing is removed.
/// \param wanted   whether an output is left alone, as it is still named, or not this run's.
/// \param dry_run  removes nothing.
/// \return in the order of their names. Errors: kIo: the cache cannot be written.
[[nodiscard]] Result<std::vector<PrunedOutput>> pruneOutputs(
    const std::filesystem::path& output_folder, const std::string& recipe,
    const std::function<bool(const std::string&)>& wanted, bool dry_run);

}  // namespace relief
