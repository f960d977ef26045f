// SPDX-License-Identifier: Apache-2.0
// The page of `relief view` and `relief-sim --page`: one HTML file with its data in it (runtime/web/view/README.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/base/file_guard.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/fields/json_value.h"

namespace relief {

/// The page of a collider, without data.
[[nodiscard]] std::string viewPage();

/// The page that plays scenes and worlds, without data: the file that RELIEF_VIEW_PAGE names, else that of an installed
/// tool, or of a build beside this one.
/// Errors: kUnsupported (there is none); kInvalidInput (the page of another release); those of readForPage().
[[nodiscard]] Result<std::string> playerPage(FileGuard& files);

/// Reads a file that a page holds or depends on. Errors: those of FileGuard::reads() and readFile().
[[nodiscard]] Result<std::string> readForPage(FileGuard& files, const std::filesystem::path& path);

/// RFC 4648, with padding and without line ends.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// The name of a file that a scene or a world names, as that names it.
[[nodiscard]] std::string nameBeside(const std::filesystem::path& file, const std::filesystem::path& scene);

struct PageMesh {
    std::string name;
    std::span<const glm::vec3> vertices;
    std::span<const glm::uvec3> triangles;
};

/// The contents of a page.
struct Page {
    std::string name = {};                          ///< without its folder
    std::size_t bytes = 0;                          ///< of the collider's file; of a scene: 0
    const Collider* collider = nullptr;             ///< shown on a page without a scene
    std::optional<PageMesh> mesh = {};              ///< of the collider
    Json check = nullptr;                           ///< the report of `relief check`
    std::optional<std::string> scene = {};          ///< text of a scene.toml
    std::string shows = {};                         ///< the one of `files` in the panel; empty: `container`
    std::vector<std::byte> container = {};          ///< of the collider in the panel
    std::map<std::string, std::string> files = {};  ///< by the names that the scene has for them

    /// \param html  viewPage(), or playerPage() for a scene. The same contents give the same bytes.
    /// Errors: kLimit: more than a page holds; those of gpuImage().
    [[nodiscard]] Result<std::string> make(const std::string& html) const;
};

}  // namespace relief
