// SPDX-License-Identifier: Apache-2.0
// Pictures of a scene: their files, the style of particles, and the camera.
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

/// Validates the files that pictures of a complete scene need. Does not use the GPU.
/// Errors: those of loadAtlas() and loadColliderMesh(), except GPU limits.
[[nodiscard]] Result<void> checkPictures(const Scene& scene, const Bounds& bounds);

/// Uploads render.atlas; returns null if the scene has none. Needs a current context.
/// Errors: those of readFile(), decodePng() and SpriteAtlas. Messages start with the place in the scene.
[[nodiscard]] Result<std::unique_ptr<SpriteAtlas>> loadAtlas(const Scene& scene);

/// Uploads render.mesh; returns null if the scene has none. Needs a current context.
/// \param bounds  of the collider, which the mesh must overlap.
/// Errors: those of loadPictureMesh() and ColliderMesh; kInvalidInput (no overlap). Messages start with the place in
/// the scene.
[[nodiscard]] Result<std::unique_ptr<ColliderMesh>> loadColliderMesh(const Scene& scene,
                                                                     const Bounds& bounds);

/// Returns the ColliderView to pass to the renderers of the scene.
[[nodiscard]] ColliderView colliderView(const LoadedScene& loaded, const WorldTextures& textures);

/// Returns the style of the particles.
/// \param scene  complete (withDefaults()).
/// \param atlas  may be null; must outlive the style.
[[nodiscard]] ParticleStyle particleStyle(const Scene& scene, const SpriteAtlas* atlas);

/// Continues the sort, which is spread over render.sort_frames > 0 frames. \return the order, valid until the next
/// call.
[[nodiscard]] ParticleOrder sortedFor(const Scene& scene, const ParticleSystem& particles,
                                      const glm::vec3& eye, DepthSorter& sorter);

/// Returns the camera of a complete scene at a time in seconds.
[[nodiscard]] Camera sceneCamera(const Scene& scene, const Bounds& bounds, double seconds);

}  // namespace relief
