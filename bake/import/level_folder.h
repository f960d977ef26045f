// SPDX-License-Identifier: Apache-2.0
// Imports a level from a file or from a folder of mesh files.
#pragma once

#include <filesystem>

#include "bake/import/import_job.h"
#include "bake/import/level.h"
#include "formats/base/result.h"

namespace relief {

/// Imports a file as importLevelInWorker() does. In a folder, imports each mesh file, sorted by name, as one mesh at
/// its own coordinates; skips other files and subfolders.
/// \param path  a file or a folder.
/// Errors: those of importLevelInWorker; for a folder also kUsage (names), kInvalidInput (no mesh file, or only some
/// with a unit), kLimit.
[[nodiscard]] Result<Level> importLevel(const std::filesystem::path& path, const ImportOptions& options = {},
                                        const ImportLimits& limits = {});

}  // namespace relief
