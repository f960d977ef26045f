// SPDX-License-Identifier: Apache-2.0
// Merges a scene into one mesh, or into the meshes and bodies of a level.
#pragma once

#include "bake/import/import_scene.h"

namespace relief {

/// Merges everything that the scene shows into one mesh, with marks for the job's names and with warnings about skipped
/// parts. Converts to metres if the frame or the job gives a unit, and to +Y up if one gives an axis. Counts all
/// triangles before allocating, because a small file can place one mesh many times.
/// Errors, without the file name: kInvalidInput (nothing to show, a node below itself, an invalid frame), kUsage (a
/// name that no triangle has), kLimit (more triangles than the job allows, or three times as many vertices).
[[nodiscard]] Result<TriangleMesh> flatten(ImportScene scene, const ImportJob& job);

/// Like flatten(), but fills TriangleMesh::level_meshes and level_bodies. Rotation, uniform scale and translation
/// become a body's pose. Shear, non-uniform scale and mirrors are applied to the mesh, which then counts as a separate
/// mesh.
/// Errors: also kLimit (more meshes or bodies than a world may have).
[[nodiscard]] Result<TriangleMesh> flattenLevel(ImportScene scene, const ImportJob& job);

}  // namespace relief
