// Mesh files for the picture of a collider: OBJ (obj.cpp) and PLY (ply_mesh.cpp). Positions and faces alone
// are read; polygons become fans of triangles. Files are untrusted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
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

/// \param name  stands for the file in messages.
/// Errors: kInvalidInput, kLimit, as above.
[[nodiscard]] Result<PictureMesh> parseObj(std::string_view text, std::string_view name);
/// ASCII and binary of either byte order; elements and properties other than those needed are skipped.
/// Errors: kInvalidInput, kLimit, as above.
[[nodiscard]] Result<PictureMesh> parsePlyMesh(std::span<const std::byte> bytes, std::string_view name);

/// For both parsers: a polygon as a fan round its first corner. False if that is more than kMeshTrianglesMax.
[[nodiscard]] bool addPolygon(std::span<const std::uint32_t> corners, PictureMesh& mesh);

}  // namespace relief
