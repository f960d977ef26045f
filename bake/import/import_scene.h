// assimp's scene as one TriangleMesh.
#pragma once

#include <assimp/scene.h>

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <string>
#include <vector>

#include "bake/import/import_names.h"
#include "bake/import/import_parts.h"
#include "bake/mesh/mesh.h"
#include "formats/base/result.h"

namespace relief {

/// Whether every face uses vertices that exist. Ask before anything walks over the faces: some readers of assimp keep
/// whatever index the file holds.
[[nodiscard]] bool indicesExist(const aiScene& scene);

/// Warns of what the scene holds that a rigid surface is not: bones, and targets of a morph.
void warnOfScene(const aiScene& scene, std::vector<std::string>& warnings);

/// \param scene  one whose indices exist. Vertices that several meshes share count once.
[[nodiscard]] MeshParts partsOf(const aiScene& scene);

/// What becomes of meshes that no node places.
enum class Unplaced : std::uint8_t { kLeaveOut, kAtRoot };

/// Adds every use of every mesh to `mesh`, with the transforms of its nodes applied and then `linear`.
/// \param shown  the file's name for messages.
/// \param names  of that scene; the mesh has marks if any are asked for.
/// Errors: kLimit (more than kTriangleMax triangles), kInvalidInput (none), kUsage (a name that no triangle has).
[[nodiscard]] Result<TriangleMesh> flatten(const aiScene& scene, const glm::dmat3& linear,
                                           const std::string& shown, Unplaced unplaced, NameMarks names,
                                           TriangleMesh mesh);

}  // namespace relief
