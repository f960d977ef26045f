// SPDX-License-Identifier: Apache-2.0
// Lists the mesh formats in a table, and detects a file's format from its first bytes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// The reader of a format (mesh_import.cpp).
enum class MeshReader : std::uint8_t { kAssimp, kAc3d, kGltf, kObj, kOff, kPly, kStl };

/// How assimp converts the units and axes of a format (import_assimp.cpp).
enum class AssimpFrame : std::uint8_t {
    kAsIs,
    kMirrored,  ///< assimp negates z
    k3ds,
    kDae,
    kFbx,
};

/// A mesh format. To add one, add a row to kRows (import_format.cpp), and a reader unless assimp reads the format.
struct MeshFormat {
    std::string_view extension;  ///< lower case, without the dot
    MeshReader reader = MeshReader::kAssimp;
    AssimpFrame frame = AssimpFrame::kAsIs;
    std::array<std::string_view, 2> signatures{};  ///< leading bytes that are unique to the format
    bool whole = false;                            ///< never references other files
};

/// Looks up a format. \param extension  in any case, without the dot. \return nullptr if unknown.
[[nodiscard]] const MeshFormat* meshFormat(std::string_view extension);

/// Returns the extension of the format whose signature the file starts with; nullopt if there is none, or if the file
/// matches `extension`.
/// \param extension  lower case, without the dot.
[[nodiscard]] std::optional<std::string> otherFormat(std::string_view extension,
                                                     std::span<const std::byte> bytes);

}  // namespace relief
