// SPDX-License-Identifier: Apache-2.0
// Animated meshes: glTF files with skins, morph targets, moving nodes and clips, and clips of other files.
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
    /// The mesh in its rest pose, as finishMesh leaves it. Its dependencies include the files of clips, and its warnings are
    /// those of all.
    TriangleMesh rest;
};

/// Reads a glTF file and the animations of others, by nodes of the same name, each in a worker process as
/// importMeshInWorker() does. Every mesh that the scene shows moves: by its skin, or by its node alone, as do its instances
/// (EXT_mesh_gpu_instancing). The first node is above all others, and turns and scales to metres and +y.
/// Errors, each naming the file: as importMeshInWorker; kUnsupported (no glTF), kLimit (animated_mesh.h), kInvalidInput (a file
/// of clips none of whose nodes the mesh has; nothing moves: no skin, no morph target, no clip).
[[nodiscard]] Result<AnimatedImport> importAnimatedInWorker(const std::filesystem::path& path,
                                                            const std::vector<std::string>& clip_files,
                                                            const ImportOptions& options = {},
                                                            const ImportLimits& limits = {});

/// One of these files alone. \param kind  kAnimated, or kClips: then the mesh has nodes and clips alone, and `rest` no vertices.
[[nodiscard]] Result<AnimatedImport> importAnimatedFileInWorker(const std::filesystem::path& path,
                                                                ImportKind kind, const ImportOptions& options,
                                                                const ImportLimits& limits);

/// Adds a clip, with a number behind its name if another one has that: then with a warning.
/// \param clip  of any name that is not empty; all else as AnimatedMesh wants it.
void addClip(AnimatedMesh& mesh, MeshClip clip, std::vector<std::string>& warnings);

/// Adds the clips of another mesh, by the names of nodes. \param from  whose vertices do not matter.
/// \param warnings  receives, without a file's name, the channels that are left out.
/// Errors, without a file's name: kInvalidInput (no name is that of a node here, or there is no clip), kLimit.
[[nodiscard]] Result<void> addClipsOf(const AnimatedMesh& from, AnimatedMesh& mesh,
                                      std::vector<std::string>& warnings);

}  // namespace relief
