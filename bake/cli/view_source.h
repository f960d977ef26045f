// What `relief view` shows, read from its files: a collider with or without its mesh, or a scene; and the page of it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bake/director/mesh_check.h"
#include "formats/base/result.h"
#include "formats/container_limits.h"

namespace relief {

struct ViewSource {
    std::string file;        ///< a container, "-" for standard input, or a scene (.toml)
    CheckRequest check;      ///< mesh empty: none
    ContainerLimits limits;  ///< of the container, or of those of a scene
    std::string events;      ///< as ViewPageInput

    [[nodiscard]] bool isScene() const;
};

struct MadePage {
    std::string html;
    /// All that it was made of; sorted. A file that names others is read again when one of them changes.
    std::vector<std::filesystem::path> files;
};

/// The template: what RELIEF_VIEW_PAGE names, else that of an installed tool, or of a build beside this one.
/// Errors: kUnsupported (there is none).
[[nodiscard]] Result<std::filesystem::path> findViewPage();

/// Reads everything, checks it as `relief check` and `relief-sim` do, and makes the page.
/// Fails as they do, and as viewPage does; kUnsupported: no template, or a scene that browsers do not play.
[[nodiscard]] Result<MadePage> makeViewPage(const ViewSource& source);

/// The same page of a check that has been made: `relief check --html`.
/// \param name  of the collider. \param container  its bytes.
[[nodiscard]] Result<std::string> makeCheckPage(const std::string& name, std::vector<std::byte> container,
                                                const MeshCheck& check, std::optional<float> max_error);

}  // namespace relief
