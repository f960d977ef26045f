// glTF 2.0, as text and binary, read here and not by assimp, which reads on where the specification says otherwise.
#pragma once

#include <glm/mat3x3.hpp>

#include "bake/import/import_files.h"
#include "bake/import/import_job.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Reads the triangles that the file's scene shows, where its nodes place them. Whatever has a part in that keeps to the
/// specification, or is an error: version, required extensions, JSON without equal keys, buffers (percent-encoded,
/// base64, of their length), accessors (sparse ones, KHR_mesh_quantization, KHR_draco_mesh_compression), indices, modes,
/// transforms, trees of nodes, skins. Skinned meshes come in the pose that the nodes have, and targets of morphs are left
/// out, with a warning each.
/// \param linear  is applied behind the transforms.
/// \param mesh    what is known of it otherwise: positions, triangles, marks, unused vertices and warnings are added.
/// Errors, naming the file: kInvalidInput, kUnsupported, kLimit; kUsage (a name that no triangle has).
[[nodiscard]] Result<TriangleMesh> readGltf(const ImportJob& job, ImportFiles& files,
                                            const glm::dmat3& linear, TriangleMesh mesh);

}  // namespace relief
