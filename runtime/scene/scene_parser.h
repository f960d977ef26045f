// SPDX-License-Identifier: Apache-2.0
// Parses scene files: TOML to the structs of scene.h.
#pragma once

#include <filesystem>
#include <string_view>

#include "formats/base/result.h"
#include "runtime/scene/scene.h"

namespace relief {

class TomlValue;  // formats/config/toml_reader.h

/// Parses a scene.
/// \param text    contents of the file; untrusted.
/// \param path    name of the file in messages. Paths in the scene are relative to its folder and may not leave it
///                (confined_path.h).
/// \param root    another folder in which the scene's files may lie; empty: none.
/// Errors: kInvalidInput, one line "file:line:column: what is wrong; what to do".
[[nodiscard]] Result<Scene> parseScene(std::string_view text, const std::filesystem::path& path,
                                       const std::filesystem::path& root = {});

/// Reads the top level of a scene. Throws TomlError.
void readScene(const TomlValue& top, Scene& scene);

/// Reads and parses a file. Errors: those of readFile() and parseScene(); kLimit above 1 MiB.
[[nodiscard]] Result<Scene> loadScene(const std::filesystem::path& path,
                                      const std::filesystem::path& root = {});

}  // namespace relief
