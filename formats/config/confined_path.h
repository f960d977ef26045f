// SPDX-License-Identifier: Apache-2.0
// Paths that a scene file names lead inside the scene's folder and nowhere else, so that a scene from elsewhere
// reads no files but its own. The command line may allow one folder more (--root).
#pragma once

#include <filesystem>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

/// A path of a scene file, ready to be opened: `folder` / `text`. That something lies there is not checked.
/// \param folder  of the scene file; empty for the current one.
/// \param text    as the file has it; may be hostile.
/// \param owner   whose folder it is, for the message.
/// \param root    another folder that the path may lead to, chosen on the command line; empty: none.
/// Errors: kInvalidInput for a path that is empty, holds a zero byte, is absolute, or leaves the folder by
/// `..` or by a symbolic link, dangling ones included, unless for `root`. The message continues the key's name: "'/x' is …; the
/// cure".
[[nodiscard]] Result<std::filesystem::path> resolveInside(const std::filesystem::path& folder,
                                                          std::string_view text,
                                                          std::string_view owner = "scene",
                                                          const std::filesystem::path& root = {});

/// Checks that `root` can be given to resolveInside(). Errors: kIo, "--root 'x' is no folder; …".
[[nodiscard]] Result<void> checkRoot(const std::filesystem::path& root);

}  // namespace relief
