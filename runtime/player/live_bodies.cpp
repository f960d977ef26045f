#include "runtime/player/live_bodies.h"

#include <algorithm>

#include "formats/base/result.h"

namespace relief {

Result<LiveBodies> LiveBodies::create(const LoadedScene& loaded) {
    LiveBodies out;
    for (std::size_t i = 0; i < loaded.live.size(); ++i) {
        if (!loaded.live[i]) {
            continue;
        }
        const LiveMesh& live = *loaded.live[i];
        const std::string& origin = loaded.scene.colliders[i].origin;
        auto collider = RELIEF_TRY(
            inFront(origin + ": collider.mesh",
                    LiveCollider::create(live.mesh.positions, trianglesOf(live.mesh), live.frames)));
        auto pass =
            RELIEF_TRY(inFront(origin + ": collider.deform",
                               WobblePass::create(live.wobble, live.mesh.positions, live.mesh.normals)));
        out.bodies_.push_back({i, std::move(collider), std::move(pass)});
    }
    return out;
}

Result<void> LiveBodies::show(double time, ColliderTextures& textures) {
    for (Body& body : bodies_) {
        body.pass.run(time);
        RELIEF_TRY(body.collider.setPositions(body.pass.buffer().name()));
        RELIEF_TRY(body.collider.update(textures, body.index));
    }
    return {};
}

const GpuMesh* LiveBodies::mesh(std::size_t index) const {
    const auto found =
        std::find_if(bodies_.begin(), bodies_.end(), [&](const Body& body) { return body.index == index; });
    return found == bodies_.end() ? nullptr : &found->collider.mesh();
}

}  // namespace relief
