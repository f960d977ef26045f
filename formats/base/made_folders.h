// SPDX-License-Identifier: Apache-2.0
// Output folders that a run creates.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Removes on destruction the folders that it created and that are empty, as after a failed run. Do not use it for
/// folders that another run is about to fill.
class MadeFolders {
  public:
    MadeFolders() = default;
    MadeFolders(const MadeFolders&) = delete;
    MadeFolders& operator=(const MadeFolders&) = delete;
    ~MadeFolders();

    /// Creates a folder as preflightFolder().
    [[nodiscard]] Result<void> make(const std::filesystem::path& path, std::string_view option);
    /// Keeps the folders created so far.
    void keep() { made_.clear(); }

  private:
    std::vector<std::filesystem::path> made_;  // parents before children
};

}  // namespace relief
