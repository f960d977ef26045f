// SPDX-License-Identifier: Apache-2.0
// Shared by `relief view` and `relief check`: the options about a mesh, and the page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/director/mesh_check.h"
#include "bake/world/world_check_report.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "runtime/command_line/option_values.h"

namespace relief {

/// The template: what RELIEF_VIEW_PAGE names, else that of an installed tool, or of a build beside this one.
/// Errors: kUnsupported (there is none).
[[nodiscard]] Result<std::filesystem::path> findViewPage();

/// Before the long work: whether a page can be made, and written. \param html  --html; empty: none
/// Errors: kUsage, kUnsupported; those of FileGuard.
[[nodiscard]] Result<void> preflightPage(const std::string& file, const std::string& mesh,
                                         const std::string& html, FileGuard& files);

/// The page of `relief view` around a check that has been made: `relief check --html`.
/// \param name  of the collider. \param container  its bytes. \param files  gets the template.
/// Errors: kUnsupported: no template; kInvalidInput: a template without its one place for data; kLimit: more than a page holds.
[[nodiscard]] Result<std::string> makeCheckPage(const std::string& name, std::vector<std::byte> container,
                                                const MeshCheck& check, std::optional<float> max_error,
                                                FileGuard& files);

/// The page of a world. \param file  of the world. \param check  made with pictures.
/// Errors: as those of makeCheckPage; those of loadAll.
[[nodiscard]] Result<std::string> makeWorldPage(const std::string& file, const ContainerLimits& limits,
                                                const WorldCheckJson& check, FileGuard& files);

/// Adds --mesh, and the fields that need it.
/// \return --mesh
OptionRef addMeshOptions(CLI::App& verb, CheckRequest& request);

/// Logs the warnings, and with -v the times.
void showCheckWarnings(const MeshCheck& check);

}  // namespace relief
