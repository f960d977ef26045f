// SPDX-License-Identifier: Apache-2.0
// The formats of mesh files as a table, and the format of a file by its first bytes, whatever its name.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace relief {

/// The code that reads a format (mesh_import.cpp).
enum class MeshReader : std::uint8_t { kAssimp, kAc3d, kGltf, kObj, kOff, kPly, kStl };

/// How assimp treats the units and axes of a file (import_assimp.cpp).
enum class AssimpFrame : std::uint8_t {
    kAsIs,
    kMirrored,  ///< assimp has negated z
    k3ds,
    kDae,
    kFbx,
};

/// One format of mesh files; a new one is a row of kRows (import_format.cpp), and a reader if assimp does not read it.
struct MeshFormat {
    std::string_view extension;  ///< lower case, without its dot
    MeshReader reader = MeshReader::kAssimp;
    AssimpFrame frame = AssimpFrame::kAsIs;
    std::array<std::string_view, 2> signatures{};  ///< first bytes, unique to the format
    bool whole = false;                            ///< refers to no other files
};

/// \param extension  in any case, without its dot. \return nullptr: there is no such format.
[[nodiscard]] const MeshFormat* meshFormat(std::string_view extension);

/// The extension of the format whose signature the file begins with. nullopt: there is none, or it is that of `extension`.
/// \param extension  lower case, without its dot.
[[nodiscard]] std::optional<std::string> otherFormat(std::string_view extension,
                                                     std::span<const std::byte> bytes);

}  // namespace relief
