// Mesh files of every format that assimp reads, as one TriangleMesh. The only file that knows assimp.
#pragma once

#include <filesystem>

#include "bake/mesh.h"
#include "formats/result.h"

namespace relief {

/// Reads a mesh file. The transforms of its nodes are applied, a mesh used n times is there n times, polygons
/// are triangulated, points and lines are left out, and where a transform mirrors, the winding is turned.
/// Materials, cameras, animation and skinning are not looked at. Files that the mesh refers to are read only
/// if they are regular files.
/// Errors, each naming the file: kIo (missing, a folder, not readable), kUnsupported (no format of this
/// extension), kInvalidInput (assimp's words, or no triangles, or as finishMesh), kLimit.
[[nodiscard]] Result<TriangleMesh> importMesh(const std::filesystem::path& path);

}  // namespace relief
