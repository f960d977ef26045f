// Finds out before the long work whether its output can be written.
#pragma once

#include <filesystem>

#include "formats/base/result.h"

namespace relief {

/// \param path  a file that will be written by writeFile; "-" for standard output.
/// Errors: kIo: it is a folder, its folder is missing or cannot be written.
[[nodiscard]] Result<void> preflightFile(const std::filesystem::path& path);

/// \param path  a folder that will be filled; made, with its parents, if it is missing.
/// Errors: kIo.
[[nodiscard]] Result<void> preflightFolder(const std::filesystem::path& path);

/// Errors: kUsage if both name the same existing file: the output would replace the input.
[[nodiscard]] Result<void> preflightDistinct(const std::filesystem::path& input,
                                             const std::filesystem::path& output);

/// Errors: kUsage if both would be written to the same file, whether or not it exists.
[[nodiscard]] Result<void> preflightTwoOutputs(const std::filesystem::path& one,
                                               const std::filesystem::path& other);

}  // namespace relief
