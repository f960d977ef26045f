// SPDX-License-Identifier: Apache-2.0
// Imports animated meshes: glTF files with skins, morph targets, moving nodes and clips, and clips from further files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bake/import/import_job.h"
#include "bake/mesh/mesh.h"
#include "formats/animation/animated_mesh.h"
#include "formats/base/result.h"

namespace relief {

struct AnimatedImport {
    AnimatedMesh mesh;
    /// The mesh in its rest pose, after finishMesh(). `dependencies` includes the clip files; `warnings` covers all
    /// files.
    TriangleMesh rest;
};

/// Reads a glTF file, and adds the animations of further glTF files by matching node names. Each file is read in a
/// worker process, as by importMeshInWorker(). Every mesh that the scene shows becomes movable, by its skin or by its
/// node; so do its instances (EXT_mesh_gpu_instancing). Node 0 is the root: it converts to metres and +Y up.
/// Errors, each naming the file: those of importMeshInWorker; kUnsupported (not glTF), kLimit (animated_mesh.h),
/// kInvalidInput (the mesh has none of a clip file's nodes; nothing moves: no skin, morph target or clip).
[[nodiscard]] Result<AnimatedImport> importAnimatedInWorker(const std::filesystem::path& path,
                                                            const std::vector<std::string>& clip_files,
                                                            const ImportOptions& options = {},
                                                            const ImportLimits& limits = {});

/// Reads a single file.
/// \param kind  kAnimated or kClips; with kClips the mesh has only nodes and clips, and `rest` has no vertices.
[[nodiscard]] Result<AnimatedImport> importAnimatedFileInWorker(const std::filesystem::path& path,
                                                                ImportKind kind, const ImportOptions& options,
                                                                const ImportLimits& limits);

/// Adds a clip. Appends a number to its name, with a warning, if the name is taken.
/// \param clip  must be valid for AnimatedMesh. Its name must not be empty; addClip() cleans and truncates it.
void addClip(AnimatedMesh& mesh, MeshClip clip, std::vector<std::string>& warnings);

/// Adds the clips of another mesh; nodes are matched by name.
/// \param from      its vertices are ignored.
/// \param warnings  receives lines about skipped channels and renamed clips, without the file name.
/// Errors, without the file name: kInvalidInput (no node name matches, or there is no clip), kLimit.
[[nodiscard]] Result<void> addClipsOf(const AnimatedMesh& from, AnimatedMesh& mesh,
                                      std::vector<std::string>& warnings);

}  // namespace relief
