// SPDX-License-Identifier: Apache-2.0
// A level of a file, or of a folder of mesh files.
#pragma once

#include <filesystem>

#include "bake/import/import_job.h"
#include "bake/import/level.h"
#include "formats/base/result.h"

namespace relief {

/// importLevelInWorker() of a file. Of a folder each mesh file in it, by name: one mesh, placed where its coordinates have it. Files
/// of other kinds and folders in it are left out.
/// \param path  of a file or a folder.
/// Errors: those of importLevelInWorker; of a folder also kUsage (names), kInvalidInput (no mesh file in it, or some with a unit and
/// some without), kLimit.
[[nodiscard]] Result<Level> importLevel(const std::filesystem::path& path, const ImportOptions& options = {},
                                        const ImportLimits& limits = {});

}  // namespace relief
