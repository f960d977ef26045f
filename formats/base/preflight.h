// Finds out before the long work whether its output can be written.
#pragma once

#include <filesystem>
#include <string_view>

#include "formats/base/result.h"

namespace relief {

/// \param path    a file that will be written by writeFile; "-" for standard output.
/// \param option  that names it, for messages: "--dump".
/// Errors: kIo: it is a folder, its folder is missing or cannot be written.
[[nodiscard]] Result<void> preflightFile(const std::filesystem::path& path, std::string_view option);

/// \param path    a folder that will be filled; made, with its parents, if it is missing.
/// \param option  that names it, for messages: "--frames".
/// Errors: kIo.
[[nodiscard]] Result<void> preflightFolder(const std::filesystem::path& path, std::string_view option);

}  // namespace relief
