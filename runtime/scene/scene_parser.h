// SPDX-License-Identifier: Apache-2.0
// A scene file: TOML to the structs of scene.h.
#pragma once

#include <filesystem>
#include <string_view>

#include "formats/base/result.h"
#include "runtime/scene/scene.h"

namespace relief {

class TomlValue;  // formats/config/toml_reader.h

/// \param text    the file's contents; may be hostile.
/// \param path    names it in messages and resolves the paths in it, which may not leave its folder
///                (confined_path.h).
/// \param root    another folder that they may lead to; empty: none.
/// Errors: kInvalidInput, one line "file:line:column: what is wrong; the cure".
[[nodiscard]] Result<Scene> parseScene(std::string_view text, const std::filesystem::path& path,
                                       const std::filesystem::path& root = {});

/// Reads the top level of a scene. Throws TomlError.
void readScene(const TomlValue& top, Scene& scene);

/// Reads a file and parses it. Fails as readFile and parseScene do, and with kLimit above 1 MiB.
[[nodiscard]] Result<Scene> loadScene(const std::filesystem::path& path,
                                      const std::filesystem::path& root = {});

}  // namespace relief
