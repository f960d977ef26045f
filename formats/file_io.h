// Whole files in and out. The only file of formats/ that touches a file system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "formats/result.h"

namespace relief {

/// Reads a whole regular file; "-" reads standard input.
/// \param size_max  refuse (kLimit) anything longer, before it is read into memory.
/// Errors: kIo (with the system's words), kLimit.
[[nodiscard]] Result<std::vector<std::byte>> readFile(const std::filesystem::path& path,
                                                      std::uint64_t size_max = std::uint64_t{4} << 30);

/// Replaces a file, all or nothing: writes a temporary file in the same folder, fsync, rename, fsync of the
/// folder. On any error the older file stays as it was and no temporary file is left. "-" writes standard
/// output; a path that exists and is no regular file (a pipe, /dev/full) is written in place.
/// Errors: kIo.
[[nodiscard]] Result<void> writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

}  // namespace relief
