#include "bake/texels/ray_scene.h"

namespace relief {

Result<RayScene> RayScene::build(PreparedMesh mesh) {
    const EmbreeMesh* const tree = RELIEF_TRY(mesh.tree());
    return RayScene(RELIEF_TRY(MeshQuery::build(std::move(mesh))), *tree);
}

}  // namespace relief
