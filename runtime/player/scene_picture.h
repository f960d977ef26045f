// SPDX-License-Identifier: Apache-2.0
// Draws the pictures of a run.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "formats/base/result.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/player/mesh_picture.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

class ScenePicture {
  public:
    /// Needs a current context, as draw() does.
    /// \param loaded, textures  must outlive this. \param path  of the depth sort; the particles use picturePath(path).
    /// Errors: those of loadAtlas, loadColliderMesh and the renderers.
    [[nodiscard]] static Result<ScenePicture> create(const LoadedScene& loaded, const WorldTextures& textures,
                                                     StepPath path);

    /// Draws the scene with the current particles. Waits for the GPU. \return 3 · width · height bytes, sRGB, top row
    /// first.
    [[nodiscard]] Result<std::vector<std::uint8_t>> draw(const ParticleSystem& particles);

  private:
    ScenePicture(const LoadedScene& loaded, Frame frame, ParticleRenderer particles)
        : loaded_(&loaded), frame_(std::move(frame)), particles_(std::move(particles)) {}

    /// Creates the renderer for the maps, or for the mesh of a single collider.
    [[nodiscard]] Result<void> makeCollider(const ColliderView& view);
    /// Draws everything except particles. \return the window depths.
    [[nodiscard]] Result<const GlTexture*> drawColliders(const Camera& camera, double seconds);

    const LoadedScene* loaded_;
    std::unique_ptr<SpriteAtlas> atlas_;
    std::unique_ptr<ColliderMesh> mesh_;
    std::optional<WobblePass> wobble_;  // of mesh_
    Frame frame_;
    std::optional<ColliderRenderer> collider_;  // null if meshes_ is used
    std::optional<MeshPicture> meshes_;
    ParticleRenderer particles_;
    ColliderStyle collider_style_;
    ParticleStyle particle_style_;
    std::optional<DepthSorter> sorter_;
};

}  // namespace relief
