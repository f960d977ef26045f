// SPDX-License-Identifier: Apache-2.0
// The pictures of a run: everything that draws a scene, made only where frames are wanted.
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
    /// \param loaded, textures  must outlive this. \param path  of the depth sort.
    /// Fails as loadAtlas, loadColliderMesh and the renderers do.
    [[nodiscard]] static Result<ScenePicture> create(const LoadedScene& loaded, const WorldTextures& textures,
                                                     StepPath path);

    /// The particles as they are now: 3 · width · height bytes sRGB, the top row first. Waits for the GPU.
    [[nodiscard]] Result<std::vector<std::uint8_t>> draw(const ParticleSystem& particles);

  private:
    ScenePicture(const LoadedScene& loaded, Frame frame, ParticleRenderer particles)
        : loaded_(&loaded), frame_(std::move(frame)), particles_(std::move(particles)) {}

    /// By maps, or by the mesh of a single collider.
    [[nodiscard]] Result<void> makeCollider(const ColliderView& view);
    /// All behind the particles. \return its depth.
    [[nodiscard]] Result<const GlTexture*> drawColliders(const Camera& camera, double seconds);

    const LoadedScene* loaded_;
    std::unique_ptr<SpriteAtlas> atlas_;
    std::unique_ptr<ColliderMesh> mesh_;
    std::optional<WobblePass> wobble_;  // of mesh_
    Frame frame_;
    std::optional<ColliderRenderer> collider_;  // or:
    std::optional<MeshPicture> meshes_;
    ParticleRenderer particles_;
    ColliderStyle collider_style_;
    ParticleStyle particle_style_;
    std::optional<DepthSorter> sorter_;
};

}  // namespace relief
