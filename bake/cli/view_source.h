// What `relief view` shows, read from its files: a collider with or without its mesh, or a scene; and the page of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/director/mesh_check.h"
#include "formats/base/result.h"
#include "formats/container_limits.h"
#include "runtime/command_line/field_options.h"

namespace relief {

/// Bytes of everything that one page holds, before they become text: more, and browsers give up.
inline constexpr std::uint64_t kViewBytesMax = std::uint64_t{128} << 20;

struct ViewSource {
    std::string file;        ///< a container, "-" for standard input, or a scene (.toml)
    CheckRequest check;      ///< mesh empty: none
    ContainerLimits limits;  ///< of the container, or of those of a scene

    [[nodiscard]] bool isScene() const;
};

struct MadePage {
    std::string html;
    /// All that it was made of.
    std::vector<std::filesystem::path> files;
};

/// The template: what RELIEF_VIEW_PAGE names, else that of an installed tool, or of a build beside this one.
/// Errors: kUnsupported (there is none).
[[nodiscard]] Result<std::filesystem::path> findViewPage();

/// Reads everything, checks it as `relief check` and `relief-sim` do, and makes the page: the same input gives the same
/// bytes. Fails as they do; kUnsupported: no template, or a scene that browsers do not play; kInvalidInput: a template
/// without its one place for data; kLimit: kViewBytesMax.
[[nodiscard]] Result<MadePage> makeViewPage(const ViewSource& source);

/// The same page of a check that has been made: `relief check --html`.
/// \param name  of the collider. \param container  its bytes.
[[nodiscard]] Result<std::string> makeCheckPage(const std::string& name, std::vector<std::byte> container,
                                                const MeshCheck& check, std::optional<float> max_error);

/// Adds --mesh, and the fields that need it.
/// \return --mesh
CLI::Option* addMeshOptions(CLI::App& verb, CheckRequest& request);

/// Logs the warnings, and with -v the times.
void showCheckWarnings(const MeshCheck& check);

}  // namespace relief
