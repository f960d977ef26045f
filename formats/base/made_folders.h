// SPDX-License-Identifier: Apache-2.0
// Folders that a run makes for its outputs.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Removes in the end what it has made and what holds nothing then, as after a run that failed. For folders that no other run
/// is about to fill.
class MadeFolders {
  public:
    MadeFolders() = default;
    MadeFolders(const MadeFolders&) = delete;
    MadeFolders& operator=(const MadeFolders&) = delete;
    ~MadeFolders();

    /// As preflightFolder().
    [[nodiscard]] Result<void> make(const std::filesystem::path& path, std::string_view option);
    /// Those made so far stay.
    void keep() { made_.clear(); }

  private:
    std::vector<std::filesystem::path> made_;  // each behind those that it lies in
};

}  // namespace relief
