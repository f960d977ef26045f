// SPDX-License-Identifier: Apache-2.0
// Mesh files for the picture of a collider, OBJ and PLY, for bodies that move and for surfaces that give birth. Positions and faces are read;
// polygons become fans of triangles. Files are untrusted.
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

/// By the file's extension, in either case: .obj or .ply. The mesh passes checkMesh; it has no normals.
/// Errors: kUnsupported (another extension), kIo, kInvalidInput with the file and, where there are lines, the
/// line, kLimit (the numbers above).
[[nodiscard]] Result<PictureMesh> loadPictureMesh(const std::filesystem::path& path);

/// Triangles in a row of one group and one material.
struct PictureMeshPart {
    std::size_t begin = 0;  ///< its first triangle; it ends where the next part begins
    std::string group;      ///< by `g`, or `o`, of an .obj; "": none
    std::string material;
};
struct NamedMesh {
    PictureMesh mesh;
    std::vector<PictureMeshPart> parts;  ///< by their beginnings; triangles before the first have no names
};
/// The same with the names that a file has: an .obj may, a .ply has none.
[[nodiscard]] Result<NamedMesh> loadNamedMesh(const std::filesystem::path& path);

/// \param extension  ".obj" or ".ply". \param name  stands for the file in messages.
/// Errors: kInvalidInput, kLimit, as above.
[[nodiscard]] Result<PictureMesh> parsePictureMesh(std::span<const std::byte> bytes,
                                                   std::string_view extension, const std::string& name);

}  // namespace relief
