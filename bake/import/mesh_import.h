// SPDX-License-Identifier: Apache-2.0
// Mesh files of every format of import_format.cpp, as one TriangleMesh: imported by a process of their own
// (importMeshInWorker), as in every tool, or in this one (importMesh), for trusted files.
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
/// and no file behind. The mesh is that of importMesh.
/// Errors, each naming the file: as importMesh; and kInvalidInput (the importer crashed), kLimit (memory or time exhausted),
/// kFailure (the worker could not be started, or was killed from outside).
[[nodiscard]] Result<TriangleMesh> importMeshInWorker(const std::filesystem::path& path,
                                                      const ImportOptions& options = {},
                                                      const ImportLimits& limits = {});

/// Reads a mesh file in this process, which a hostile file may crash. In the library bake_assimp.
///
/// The transforms of its nodes are applied, instances are repeated, polygons are triangulated, points and lines are left out
/// with a warning (import_scene.h), and mirroring transforms reverse the winding. Cameras and animation are ignored, and
/// materials except for their names; skinned meshes of glTF have the pose of the file's nodes, those of other formats and
/// morphed ones their modelled shape, with a warning. Only regular files below the mesh's folder are read (import_files.h).
/// Errors, each naming the file: kIo (missing, a folder, not readable), kUnsupported (a format or feature that is not read),
/// kInvalidInput (a violation of the format, no triangles, or as finishMesh), kUsage (a name that no triangle has), kLimit.
[[nodiscard]] Result<TriangleMesh> importMesh(const std::filesystem::path& path,
                                              const ImportOptions& options = {});

}  // namespace relief
