// SPDX-License-Identifier: Apache-2.0
// Shared by `relief view` and `relief check`: the options of a mesh, and the page.
#pragma once

#include <optional>
#include <string>

#include "bake/pipeline/mesh_check.h"
#include "bake/report/world_report.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "runtime/command_line/option_values.h"

namespace relief {

/// Checks, before the long work, that a page can be made and written. \param html  the value of --page; empty: no page
/// \return playerPage() for a world, otherwise empty
/// Errors: kUsage; those of playerPage() and FileGuard.
[[nodiscard]] Result<std::string> preflightPage(const std::string& file, const std::string& mesh,
                                                const std::string& html, FileGuard& files);

/// Makes the page of `relief check --page` from a finished check.
/// \param name  name of the collider \param bytes  size of its file
/// Errors: kLimit if the data is larger than a page may hold; those of gpuImage.
[[nodiscard]] Result<std::string> makeCheckPage(const std::string& name, std::size_t bytes,
                                                const MeshCheck& check, std::optional<float> max_error);

/// Makes the page of a world.
/// \param file  world.json \param check  a check with pictures \param player  result of preflightPage
/// Errors: kLimit if the data is larger than a page may hold; those of readForPage.
[[nodiscard]] Result<std::string> makeWorldPage(const std::string& file, const WorldCheckJson& check,
                                                const std::string& player, FileGuard& files);

/// Adds --mesh and the options that need it. \return --mesh
OptionRef addMeshOptions(CLI::App& verb, CheckRequest& request);

/// Logs the warnings and, with -v, the durations of the check.
void showCheckWarnings(const MeshCheck& check);

}  // namespace relief
