// SPDX-License-Identifier: Apache-2.0
// Imports a mesh file of any format of import_format.cpp as one TriangleMesh. The tools use a worker process
// (importMeshInWorker); importMesh works in this process, for trusted files.
#pragma once

#include <filesystem>

#include "bake/import/import_job.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Reads a mesh file in a worker process (relief-import, beside this program or library, or in ../libexec/relief). The
/// worker has limits on memory and time, cannot write files, and reads only files below the mesh's folder. Its output
/// is validated like an untrusted file. Blocks; leaves no process or file behind. The result equals that of importMesh.
/// Errors, each naming the file: those of importMesh; kInvalidInput (the importer crashed), kLimit (memory or time
/// exhausted), kFailure (the worker could not be started, or was killed from outside).
[[nodiscard]] Result<TriangleMesh> importMeshInWorker(const std::filesystem::path& path,
                                                      const ImportOptions& options = {},
                                                      const ImportLimits& limits = {});

/// Reads a mesh file in this process, which a hostile file may crash; defined in the library bake_assimp.
///
/// Applies node transforms, repeats instances, triangulates polygons, skips points and lines with a warning
/// (import_scene.h), and reverses the winding under mirrors. Ignores cameras, animation, and materials except their
/// names. Skinned glTF meshes get the pose of the file's nodes; skinned meshes of other formats and morphed meshes keep
/// their modelled shape, with a warning. Reads only regular files below the mesh's folder (import_files.h).
/// Errors, each naming the file: kIo (missing, a folder, not readable), kUnsupported (format or feature), kInvalidInput
/// (malformed, no triangles, or as for finishMesh), kUsage (an unmatched entry of `names`), kLimit.
[[nodiscard]] Result<TriangleMesh> importMesh(const std::filesystem::path& path,
                                              const ImportOptions& options = {});

}  // namespace relief
