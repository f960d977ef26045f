// SPDX-License-Identifier: Apache-2.0
// Bakes one mesh of a level into its containers: the whole mesh or its tiles, and their coarse versions.
#pragma once

#include <string>
#include <vector>

#include "bake/pipeline/stages.h"
#include "bake/world/world_cache.h"
#include "bake/world/world_collider.h"

namespace relief {

struct LevelMeshBake {
    const WorldRequest& world;
    const BakeRequest& request;  ///< of the mesh
    const SolidMesh& solid;
    TriangleMesh& mesh;       ///< moved from
    const std::string& unit;  ///< of the level
    const PatchTileOptions& tiles;
    const ContainerNames& names;
};

/// Bakes and writes the colliders of a mesh.
/// \param collider  copied to each result; receives the measured accuracy and warnings.
/// \return the written colliders.
[[nodiscard]] Result<std::vector<WorldColliderResult>> bakeLevelMesh(const LevelMeshBake& of,
                                                                     WorldColliderResult& collider);

}  // namespace relief
