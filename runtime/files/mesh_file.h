// SPDX-License-Identifier: Apache-2.0
// Reads OBJ and PLY files for pictures, moving bodies and emitting surfaces: positions, colours and faces. Polygons
// become triangle fans. Files are untrusted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/result.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {

inline constexpr std::size_t kMeshBytesMax = std::size_t{1} << 30;
inline constexpr std::size_t kMeshVerticesMax = 20'000'000;
inline constexpr std::size_t kMeshTrianglesMax = 40'000'000;

/// Reads an .obj or .ply file; the extension is case-insensitive. The mesh passes checkMesh and has no normals.
/// Errors: kUnsupported (another extension); kIo; kInvalidInput, with the file and, for text, the line; kLimit (the
/// maxima above).
[[nodiscard]] Result<PictureMesh> loadPictureMesh(const std::filesystem::path& path);

/// Consecutive triangles with the same group and material.
struct PictureMeshPart {
    std::size_t begin = 0;  ///< first triangle; the part ends where the next one begins
    std::string group;      ///< `g` or `o` of an .obj; "": none
    std::string material;
};
struct NamedMesh {
    PictureMesh mesh;
    std::vector<PictureMeshPart> parts;  ///< ascending; triangles before the first part have no names
};
/// Like loadPictureMesh(), with groups and materials, which only .obj files can have.
[[nodiscard]] Result<NamedMesh> loadNamedMesh(const std::filesystem::path& path);

/// \param extension  ".obj" or ".ply". \param name  file name for messages.
/// Errors: kInvalidInput, kLimit, as above.
[[nodiscard]] Result<PictureMesh> parsePictureMesh(std::span<const std::byte> bytes,
                                                   std::string_view extension, const std::string& name);

}  // namespace relief
