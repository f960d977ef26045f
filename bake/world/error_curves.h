// SPDX-License-Identifier: Apache-2.0
// Reads and writes the error curves that determine how a level's budget is divided among its colliders. They are stored
// beside its containers, so that a run without changes needs no planning.
//
//     {"format": "relief-curves", "version": 1, "curves": {"KEY": [bytes, errors, bytes, errors, …], …}}
//
// A key is the hash of everything its curve depends on (assetKey). The file is trusted like the cache of containers;
// deleting it costs one plan per mesh.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "bake/patches/patch_planner.h"
#include "bake/recipe/recipe_jobs.h"
#include "formats/base/result.h"

namespace relief {

using ErrorCurves = std::map<std::string, ErrorCurve>;

/// Errors: kInvalidInput (not a file of this version), kLimit.
[[nodiscard]] Result<ErrorCurves> parseErrorCurves(std::string_view text);
[[nodiscard]] std::string errorCurvesText(const ErrorCurves& curves);

/// Loads the curves of a folder; empty if there is no file. Does not follow symbolic links. Errors: kInvalidInput, kIo,
/// kLimit.
[[nodiscard]] Result<ErrorCurves> loadErrorCurves(const std::filesystem::path& folder);

/// Replaces the curves of a folder. Errors: kIo.
[[nodiscard]] Result<void> saveErrorCurves(const std::filesystem::path& folder, const ErrorCurves& curves);

}  // namespace relief
