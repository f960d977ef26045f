// Mesh files for the picture of a collider, OBJ and PLY, and for bodies that move. Positions and faces alone are read;
// polygons become fans of triangles. Files are untrusted.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

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

/// \param extension  ".obj" or ".ply". \param name  stands for the file in messages.
/// Errors: kInvalidInput, kLimit, as above.
[[nodiscard]] Result<PictureMesh> parsePictureMesh(std::span<const std::byte> bytes,
                                                   std::string_view extension, const std::string& name);

}  // namespace relief
