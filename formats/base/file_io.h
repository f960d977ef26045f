// SPDX-License-Identifier: Apache-2.0
// Whole files in and out. Libraries and tools read and write through this file, so that limits, messages and the
// promise of whole outputs are the same everywhere. (Below it lies temporary_file.h.)
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

/// Whether a path names a pipe, a socket or a disk: who opens one may wait for ever, and so they are neither read nor
/// written. /dev/stdin, /dev/fd/N and their like are none: the shell has opened them.
[[nodiscard]] bool mayBlock(const std::filesystem::path& path);

/// The number in /dev/stdin, /dev/fd/N and their like; nullopt: some other path. What the shell has opened is written as
/// it is: by its name it would be written from its begin on, or replaced.
[[nodiscard]] std::optional<int> descriptorOf(const std::filesystem::path& path);

/// Reads a whole file; "-" reads standard input. Devices are read to their end.
/// \param size_max  refuse (kLimit) anything longer: a regular file before any of it is read, a stream after
///                  size_max + 1 bytes.
/// Errors: kIo (with the system's words), kLimit.
[[nodiscard]] Result<std::vector<std::byte>> readFile(const std::filesystem::path& path,
                                                      std::uint64_t size_max = std::uint64_t{4} << 30);

/// Replaces a file, all or nothing: writes a temporary file in the same folder (temporary_file.h), fsync,
/// rename, fsync of the folder. On any error before the rename the older file stays as it was and no
/// temporary file is left. If only the last fsync fails, the message says that the new file is in place.
///
/// A new file has the permissions that the umask leaves. An older file's permission bits are kept; its owner,
/// ACLs and other names (hard links) are not. Temporary files that killed processes left in the folder are removed. A symbolic link stays, and the file that it points to is
/// replaced. "-" writes standard output; /dev/stdout, /dev/fd/N and devices (/dev/full) are written in place.
/// Errors: kIo, with the system's words.
[[nodiscard]] Result<void> writeFile(const std::filesystem::path& path, std::span<const std::byte> bytes);

/// A path for a message: escapedUtf8 in single quotes, so that the message stays one line in the order of its characters.
[[nodiscard]] std::string quotedPath(const std::filesystem::path& path);

/// An absolute path without symbolic links, "." and ".."; parts that do not exist stay. Dangling links are followed too:
/// by the time that the path is opened their target may be there.
/// \param error  set where links lead in a circle, or a folder cannot be looked into.
[[nodiscard]] std::filesystem::path destination(const std::filesystem::path& path, std::error_code& error);

/// \param path    a file that will be written by writeFile; "-" for standard output.
/// \param option  that names it, for messages: "--dump".
/// Errors: kIo: it is a folder, its folder is missing or cannot be written.
[[nodiscard]] Result<void> preflightFile(const std::filesystem::path& path, std::string_view option);

/// \param path    a folder that will be filled; made, with its parents, if it is missing.
/// \param option  that names it, for messages: "--frames".
/// Errors: kIo.
[[nodiscard]] Result<void> preflightFolder(const std::filesystem::path& path, std::string_view option);

}  // namespace relief
