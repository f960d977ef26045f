// Mesh files of every format of import_format.cpp, as one TriangleMesh: imported by a process of their own
// (importMeshInWorker), as every tool does, or in this one (importMesh), for files that one trusts.
#pragma once

#include <filesystem>

#include "bake/import/import_job.h"
#include "bake/import/import_units.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Reads a mesh file in a worker process (the program relief-import beside this one, or in ../libexec/relief)
/// with limits of memory and time, without rights to write any file or to read one that is not below the
/// mesh's folder. The worker's answer is checked like an untrusted file. Blocks; leaves no process
/// and no file behind. What the mesh means is as in importMesh.
/// Errors, each naming the file: as importMesh; and kInvalidInput (the importer crashed), kLimit (memory or time is used up), kFailure (the worker could
/// not be started, or was killed by somebody else).
[[nodiscard]] Result<TriangleMesh> importMeshInWorker(const std::filesystem::path& path,
                                                      const ImportOptions& options = {},
                                                      const ImportLimits& limits = {});

/// Reads a mesh file in this process, which a hostile file may crash. In the library bake_assimp.
///
/// The transforms of its nodes are applied, a mesh used n times is there n times, polygons are
/// triangulated, points and lines are left out with a warning (import_scene.h), and where a transform
/// mirrors, the winding is turned. Cameras and animation are not looked at, and of materials only the
/// names that ImportOptions asks for; skinned meshes of glTF come in the pose of the file's nodes, those of
/// other formats and morphed ones as they were modelled, with a warning. Only files below the mesh's folder are read, and only regular ones (import_files.h).
/// Errors, each naming the file: kIo (missing, a folder, not readable), kUnsupported (a format, or a part of it, that is
/// not read), kInvalidInput (not what the format says, no triangles, or as finishMesh), kUsage (a name that no triangle
/// has), kLimit.
[[nodiscard]] Result<TriangleMesh> importMesh(const std::filesystem::path& path,
                                              const ImportOptions& options = {});

}  // namespace relief
