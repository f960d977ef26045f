// SPDX-License-Identifier: Apache-2.0
// Pictures of a scene: the files that they need, the style of its particles, and its camera.
#pragma once

#include <memory>

#include "formats/base/result.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_mesh.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/picture/sprite_atlas.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// Reads the files that pictures of a complete scene need; without a GPU.
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

/// The colliders as renderers see them.
[[nodiscard]] ColliderView colliderView(const LoadedScene& loaded, const WorldTextures& textures);

/// \param scene  complete (withDefaults).
/// \param atlas  may be null; must outlive the style.
[[nodiscard]] ParticleStyle particleStyle(const Scene& scene, const SpriteAtlas* atlas);

/// Goes on with the sort that render.sort_frames spreads over frames, above 0. \return the order, until the next call.
[[nodiscard]] ParticleOrder sortedFor(const Scene& scene, const ParticleSystem& particles,
                                      const glm::vec3& eye, DepthSorter& sorter);

/// The camera of a complete scene after so many seconds.
[[nodiscard]] Camera sceneCamera(const Scene& scene, const Bounds& bounds, double seconds);

}  // namespace relief
