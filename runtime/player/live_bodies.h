// The colliders of a scene that deform, on the GPU: what a player does with them each step.
#pragma once

#include <vector>

#include "formats/base/result.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/collider/live_collider.h"
#include "runtime/collider/wobble_pass.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

class LiveBodies {
  public:
    /// Needs a current context; empty without live colliders.
    /// Fails as LiveCollider and WobblePass do; messages begin with the place in the scene.
    [[nodiscard]] static Result<LiveBodies> create(const LoadedScene& loaded);

    [[nodiscard]] bool empty() const { return bodies_.empty(); }
    /// Deforms all of them to a time, in seconds, and renders their maps. Before each step, for its end.
    /// Fails as LiveCollider::update does.
    [[nodiscard]] Result<void> show(double time, ColliderTextures& textures);
    /// The mesh of the scene's collider with that index, as it was last shown; null: that one does not deform.
    [[nodiscard]] const GpuMesh* mesh(std::size_t index) const;

  private:
    struct Body {
        std::size_t index;  // in the scene
        LiveCollider collider;
        WobblePass pass;
    };
    std::vector<Body> bodies_;
};

}  // namespace relief
