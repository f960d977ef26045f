// assimp's scene as one TriangleMesh.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <string>
#include <vector>

#include "bake/import/import_job.h"
#include "bake/import/import_parts.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Whether every face uses vertices that exist. Ask before anything walks over the faces: some readers of assimp keep
/// whatever index the file holds.
[[nodiscard]] bool indicesExist(const aiScene& scene);

/// Warns of what the scene holds that a rigid surface is not: bones, and targets of a morph.
void warnOfScene(const aiScene& scene, std::vector<std::string>& warnings);

/// \param scene  one whose indices exist.
[[nodiscard]] MeshParts partsOf(const aiScene& scene);

/// Cuts the scene's polygons into triangles; lines and points stay. \param scene  one whose indices exist.
void triangulate(aiScene& scene);

/// Adds every use of every mesh to `mesh`, with the transforms of its nodes applied and then `linear`. A triangle has the
/// names of its material, of its mesh, and of the node that uses it and of all above that.
/// \param mesh  has marks then if the job asks for names.
/// Errors: kLimit (more triangles than the job allows), kInvalidInput (none), kUsage (a name that no triangle has).
[[nodiscard]] Result<TriangleMesh> flatten(const aiScene& scene, const glm::dmat3& linear,
                                           const ImportJob& job, TriangleMesh mesh);

}  // namespace relief
