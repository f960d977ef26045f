// SPDX-License-Identifier: Apache-2.0
// The files that an import may read: the mesh, from memory, and regular files below its folder. No other path can be
// reached: the kernel resolves each beneath the folder (openat2).
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

/// Limit of all files of a mesh together, in bytes.
inline constexpr std::uint64_t kImportBytesMax = std::uint64_t{4} << 30;

class ImportFiles {
  public:
    /// \param folder  descriptor of the mesh's folder, borrowed; -1 for none: then only the mesh can be read.
    /// \param name    the mesh's file name in it.
    /// \param bytes   the mesh's contents, borrowed.
    ImportFiles(int folder, std::string name, std::span<const std::byte> bytes)
        : folder_(folder), name_(std::move(name)), bytes_(bytes), left_(kImportBytesMax - bytes.size()) {}

    [[nodiscard]] bool isMesh(std::string_view path) const;
    [[nodiscard]] std::span<const std::byte> meshBytes() const { return bytes_; }

    /// \return true for a regular file below the folder; nothing is read.
    [[nodiscard]] bool exists(std::string_view path);

    /// The contents, recorded in read(). nullopt, recorded in refused(): no regular file below the folder, or beyond the
    /// limit of all files.
    [[nodiscard]] std::optional<std::vector<std::byte>> open(std::string_view path);

    /// The XXH3-128 of each file that was read, without the mesh itself, by its path below the folder.
    [[nodiscard]] const std::map<std::string, std::string>& read() const { return read_; }
    /// Names that could not be opened, with the reason; the first few, each once.
    [[nodiscard]] const std::vector<std::string>& refused() const { return refused_; }

  private:
    /// \return an empty one with `why`.
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
