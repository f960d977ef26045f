// SPDX-License-Identifier: Apache-2.0
// Gives an import access to its files: the mesh in memory, and regular files below the mesh's folder. The kernel
// resolves each path beneath that folder (openat2), so no other file can be reached.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/descriptor.h"

namespace relief {

/// Limit on the total size of a mesh's files, in bytes.
inline constexpr std::uint64_t kImportBytesMax = std::uint64_t{4} << 30;

class ImportFiles {
  public:
    /// Gives access to a mesh and its folder.
    /// \param folder  descriptor of the mesh's folder, borrowed; -1: only the mesh can be read.
    /// \param name    file name of the mesh in that folder.
    /// \param bytes   contents of the mesh, borrowed.
    ImportFiles(int folder, std::string name, std::span<const std::byte> bytes)
        : folder_(folder), name_(std::move(name)), bytes_(bytes), left_(kImportBytesMax - bytes.size()) {}

    [[nodiscard]] bool isMesh(std::string_view path) const;
    [[nodiscard]] std::span<const std::byte> meshBytes() const { return bytes_; }

    /// Returns true for a regular file below the folder, without reading it.
    [[nodiscard]] bool exists(std::string_view path);

    /// Reads a file and records it in read(). Returns nullopt and records it in refused() if it is not a regular file
    /// below the folder, or if it exceeds the total limit.
    [[nodiscard]] std::optional<std::vector<std::byte>> open(std::string_view path);

    /// XXH3-128 of each file read except the mesh, by path below the folder.
    [[nodiscard]] const std::map<std::string, std::string>& read() const { return read_; }
    /// Paths that could not be opened, with the reason; the first few, without duplicates.
    [[nodiscard]] const std::vector<std::string>& refused() const { return refused_; }

  private:
    /// Returns an empty descriptor and sets `why` on failure.
    Descriptor openBeneath(const std::string& path, std::string& why) const;
    void refuse(std::string_view path, const std::string& why);

    int folder_;
    std::string name_;
    std::span<const std::byte> bytes_;
    std::uint64_t left_;
    std::map<std::string, std::string> read_;
    std::vector<std::string> refused_;
};

}  // namespace relief
