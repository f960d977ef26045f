// What a scene's pictures need besides the scene: files that it names, and where its camera is.
#pragma once

#include <memory>

#include "formats/base/result.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_mesh.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/picture/sprite_atlas.h"
#include "runtime/scene/scene.h"

namespace relief {

/// Reads what the pictures of a complete scene need, and needs no GPU.
/// Fails as loadAtlas and loadColliderMesh do, but for a GPU's limits.
[[nodiscard]] Result<void> checkPictures(const Scene& scene, const Bounds& bounds);

/// render.atlas on the GPU; null if the scene has none.
/// Fails as readFile, decodePng and SpriteAtlas do; messages begin with the place in the scene.
[[nodiscard]] Result<std::unique_ptr<SpriteAtlas>> loadAtlas(const Scene& scene);

/// render.mesh on the GPU; null if the scene has none.
/// \param bounds  of the collider, which the mesh must meet.
/// Fails as loadPictureMesh and ColliderMesh do, and with kInvalidInput (it lies elsewhere); messages begin with the place
/// in the scene.
[[nodiscard]] Result<std::unique_ptr<ColliderMesh>> loadColliderMesh(const Scene& scene,
                                                                     const Bounds& bounds);

/// \param scene  complete (withDefaults).
/// \param atlas  may be null; must outlive the style.
[[nodiscard]] ParticleStyle particleStyle(const Scene& scene, const SpriteAtlas* atlas);

/// Where the camera of a complete scene is after so many seconds.
[[nodiscard]] Camera sceneCamera(const Scene& scene, const Bounds& bounds, double seconds);

}  // namespace relief
