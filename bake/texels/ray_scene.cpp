#include "bake/texels/ray_scene.h"

namespace relief {

Result<RayScene> RayScene::build(PreparedMesh mesh) {
    const EmbreeMesh* const tree = RELIEF_TRY(mesh.tree());
    MeshQuery query = RELIEF_TRY(MeshQuery::build(mesh));
    return RayScene(std::move(mesh), *tree, std::move(query));
}

}  // namespace relief
