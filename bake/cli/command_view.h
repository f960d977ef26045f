// SPDX-License-Identifier: Apache-2.0
// Shared by `relief view` and `relief check`: the options about a mesh, and the page.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bake/pipeline/mesh_check.h"
#include "bake/report/world_report.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "runtime/command_line/option_values.h"

namespace relief {

/// Before the long work: whether a page can be made, and written. \param html  --html; empty: none
/// \return the player, for the page of a world; else empty.
/// Errors: kUsage; kUnsupported: no player; kInvalidInput: a player without its one place for data; those of FileGuard.
[[nodiscard]] Result<std::string> preflightPage(const std::string& file, const std::string& mesh,
                                                const std::string& html, FileGuard& files);

/// The page of `relief view` around a check that has been made: `relief check --html`.
/// \param name  of the collider. \param bytes  of its file.
/// Errors: kLimit: more than a page holds; those of gpuImage.
[[nodiscard]] Result<std::string> makeCheckPage(const std::string& name, std::size_t bytes,
                                                const MeshCheck& check, std::optional<float> max_error);

/// The page of a world. \param file  of the world. \param check  made with pictures. \param player  of preflightPage.
/// Errors: kLimit: more than a page holds; those of readForPage.
[[nodiscard]] Result<std::string> makeWorldPage(const std::string& file, const WorldCheckJson& check,
                                                const std::string& player, FileGuard& files);

/// Adds --mesh, and the fields that need it.
/// \return --mesh
OptionRef addMeshOptions(CLI::App& verb, CheckRequest& request);

/// Logs the warnings, and with -v the times.
void showCheckWarnings(const MeshCheck& check);

}  // namespace relief
