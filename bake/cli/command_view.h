// Shared by `relief view` and `relief check`: the options about a mesh, and the page.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/director/mesh_check.h"
#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "runtime/command_line/option_values.h"

namespace relief {

/// The template: what RELIEF_VIEW_PAGE names, else that of an installed tool, or of a build beside this one.
/// Errors: kUnsupported (there is none).
[[nodiscard]] Result<std::filesystem::path> findViewPage();

/// The page of `relief view` around a check that has been made: `relief check --html`.
/// \param name  of the collider. \param container  its bytes. \param files  gets the template.
/// Errors: kUnsupported: no template; kInvalidInput: a template without its one place for data; kLimit: more than a page holds.
[[nodiscard]] Result<std::string> makeCheckPage(const std::string& name, std::vector<std::byte> container,
                                                const MeshCheck& check, std::optional<float> max_error,
                                                FileGuard& files);

/// Adds --mesh, and the fields that need it.
/// \return --mesh
CLI::Option* addMeshOptions(CLI::App& verb, CheckRequest& request);

/// Logs the warnings, and with -v the times.
void showCheckWarnings(const MeshCheck& check);

}  // namespace relief
