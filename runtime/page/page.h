// SPDX-License-Identifier: Apache-2.0
// Writes the page of `relief view` and `relief-sim --page`: one HTML file with its data (runtime/web/view).
#pragma once

#include <cstddef>
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

/// Returns the page for a collider, without data.
[[nodiscard]] std::string viewPage();

/// Returns the page that plays scenes and worlds, without data: the file named by RELIEF_VIEW_PAGE, else the
/// installed file, else the file of a web build next to this build.
/// Errors: kUnsupported (not found), kInvalidInput (of another release); those of readForPage().
[[nodiscard]] Result<std::string> playerPage(FileGuard& files);

/// Reads a file for a page. Errors: those of FileGuard::reads() and readFile().
[[nodiscard]] Result<std::string> readForPage(FileGuard& files, const std::filesystem::path& path);

/// Encodes bytes in Base64 (RFC 4648), with padding and without line breaks.
[[nodiscard]] std::string base64(std::span<const std::byte> bytes);

/// Returns the path of a file relative to the folder of a scene or world.
[[nodiscard]] std::string relativeName(const std::filesystem::path& file, const std::filesystem::path& scene);

struct PageMesh {
    std::string name;
    std::span<const glm::vec3> vertices;
    std::span<const glm::uvec3> triangles;
};

/// The contents of a page.
struct Page {
    std::string name = {};                  ///< file name, without folder
    std::size_t bytes = 0;                  ///< size of the collider's file; 0 for a scene
    const Collider* collider = nullptr;     ///< the collider, for a page without a scene
    std::optional<PageMesh> mesh = {};      ///< source mesh of the collider
    Json check = nullptr;                   ///< the report of `relief check`
    std::optional<std::string> scene = {};  ///< text of a scene.toml
    /// Key in `files` of the collider that the page's panel describes; if empty, the panel describes `container`.
    std::string shows = {};
    std::vector<std::byte> container = {};          ///< collider that the panel describes
    std::map<std::string, std::string> files = {};  ///< keyed by their names in the scene

    /// Inserts the data into a page. Equal contents give equal bytes.
    /// \param html  viewPage(), or playerPage() for a scene.
    /// Errors: kLimit (too much data for a page); those of gpuImage().
    [[nodiscard]] Result<std::string> make(const std::string& html) const;
};

}  // namespace relief
