// SPDX-License-Identifier: Apache-2.0
// The curves by which the bytes of a level are shared, kept beside its containers, so that a run with nothing to do plans
// nothing.
//
//     {"format": "relief-curves", "version": 1, "curves": {"KEY": [bytes, errors, bytes, errors, …], …}}
//
// A key is the hash of all that its curve depends on (assetKey). The file is trusted as much as the cache of containers is: to
// delete it costs a plan of each mesh.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "bake/patches/patch_planner.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/base/result.h"

namespace relief {

/// By key.
using ErrorCurves = std::map<std::string, ErrorCurve>;

/// Errors: kInvalidInput: no file of this version; kLimit.
[[nodiscard]] Result<ErrorCurves> parseErrorCurves(std::string_view text);
[[nodiscard]] std::string errorCurvesText(const ErrorCurves& curves);

/// Those of a folder; no file is no error. Does not follow a symbolic link. Errors: kInvalidInput, kIo, kLimit.
[[nodiscard]] Result<ErrorCurves> loadErrorCurves(const std::filesystem::path& folder);

/// In place of those that are there. Errors: kIo.
[[nodiscard]] Result<void> saveErrorCurves(const std::filesystem::path& folder, const ErrorCurves& curves);

}  // namespace relief
