// SPDX-License-Identifier: Apache-2.0
// Reads and writes whole files. All libraries and tools use this header, so limits, messages and atomic replacement are
// the same everywhere. temporary_file.h is the layer below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "formats/base/result.h"

namespace relief {

/// Returns whether the path is a pipe, a socket or a block device, which readFile() and writeFile() reject: opening a
/// pipe could block forever. Returns false for /dev/stdin, /dev/fd/N and similar paths, which are already open.
[[nodiscard]] bool mayBlock(const std::filesystem::path& path);

/// Returns N for /dev/fd/N, /dev/stdin and similar paths, otherwise nullopt. Write to descriptor N: opening the path
/// again would restart at the beginning of the file or replace the file.
[[nodiscard]] std::optional<int> descriptorOf(const std::filesystem::path& path);

/// Reads a whole file. "-" reads standard input. Devices are read to their end.
/// \param size_max  longest accepted file, in bytes. Longer regular files are rejected before reading, streams after
///                  size_max + 1 bytes.
/// Errors: kIo (with the system's message), kLimit.
[[nodiscard]] Result<std::vector<std::byte>> readFile(const std::filesystem::path& path,
                                                      std::uint64_t size_max = std::uint64_t{4} << 30);

/// Replaces a file atomically: writes a temporary file in the same folder (temporary_file.h), then fsync, rename, and
/// fsync of the folder. An error before the rename leaves the old file unchanged and no temporary file behind. If only
/// the last fsync fails, the message states that the new file is in place.
///
/// A new file gets the permissions that the umask allows. Replacing a file keeps its permission bits, but not its
/// owner, ACLs or hard links. Temporary files of killed processes are removed from the folder. A symbolic link is kept
/// and its target is replaced. "-" writes to standard output; /dev/stdout, /dev/fd/N and devices (/dev/full) are
/// written in place.
/// Errors: kIo, with the system's message.
[[nodiscard]] Result<void> writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// Replaces a file like writeFile().
[[nodiscard]] Result<void> writeText(const std::filesystem::path& path, std::string_view text);

/// Formats a path for a one-line message: escapedUtf8 in single quotes.
[[nodiscard]] std::string quotedPath(const std::filesystem::path& path);

/// Returns an absolute path without symbolic links, "." and ".."; missing components are kept. Dangling links are
/// followed too, because their targets may exist by the time the path is opened.
/// \param error  set if links form a cycle or a folder cannot be read.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path, std::error_code& error);

/// Checks that writeFile() can write a file.
/// \param path    "-" for standard output.
/// \param option  the option that names it, for messages: "--dump".
/// Errors: kIo if it is a folder, or if its folder is missing or not writable.
[[nodiscard]] Result<void> preflightFile(const std::filesystem::path& path, std::string_view option);

/// Creates a folder, with its parents, if it is missing, and checks that it is writable.
/// \param option  the option that names it, for messages: "--frames".
/// Errors: kIo.
[[nodiscard]] Result<void> preflightFolder(const std::filesystem::path& path, std::string_view option);

}  // namespace relief
