// SPDX-License-Identifier: Apache-2.0
// Confines the paths in a scene file to the scene's folder, so that a downloaded scene reads only its own files. The
// command line may allow one more folder (--root).
#pragma once

#include <filesystem>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

/// Resolves a path from a scene file to `folder` / `text`. Does not check that the file exists.
/// \param folder  folder of the scene file; empty for the current folder.
/// \param text    path as written in the file; untrusted.
/// \param owner   kind of file that owns the folder, for the message.
/// \param root    additional allowed folder, chosen on the command line; empty: none.
/// Errors: kInvalidInput if the path is empty, contains a zero byte, is absolute, or leaves the folder (except into
/// `root`) by `..` or a symbolic link, even a dangling one. The message is "'/x' is …; …"; callers prefix it with
/// the key: "path = ".
[[nodiscard]] Result<std::filesystem::path> resolveInside(const std::filesystem::path& folder,
                                                          std::string_view text,
                                                          std::string_view owner = "scene",
                                                          const std::filesystem::path& root = {});

/// Checks that `root` is a folder. Errors: kIo, "--root 'x' is not a folder; …".
[[nodiscard]] Result<void> checkRoot(const std::filesystem::path& root);

}  // namespace relief
