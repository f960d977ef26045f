// SPDX-License-Identifier: Apache-2.0
// Draws the colliders of a scene as the meshes in render.meshes, animated and deformed, with the scene's weather and
// the footprints that characters have left so far.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "formats/base/result.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/mesh_renderer.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/scene/scene_meshes.h"

namespace relief {

class MeshPicture {
  public:
    /// Needs a current context, as draw() does.
    /// \param loaded  with render.meshes; must outlive this.
    /// Errors: those of loadDrawnMeshes(), MeshRenderer and WobblePass.
    [[nodiscard]] static Result<MeshPicture> create(const LoadedScene& loaded);

    /// Overwrites the target's colour and depth, with the sky as background. Adds the footprints since the previous
    /// call, or since the beginning of the scene. A call with an earlier time than the previous call adds only the
    /// footprints at its own time.
    /// \param seconds  time of the scene. Errors: those of MeshRenderer::draw().
    [[nodiscard]] Result<void> draw(const CameraMatrices& camera, double seconds, const RenderTarget& target);

    /// Returns MeshRenderer::depth().
    [[nodiscard]] const GlTexture& depth() const { return renderer_.depth(); }

  private:
    MeshPicture(const LoadedScene& loaded, DrawnMeshes drawn, MeshRenderer renderer)
        : loaded_(&loaded), drawn_(std::move(drawn)), renderer_(std::move(renderer)) {}

    [[nodiscard]] Result<void> pose(double seconds);
    [[nodiscard]] Result<void> press(double seconds);

    const LoadedScene* loaded_;
    DrawnMeshes drawn_;
    MeshRenderer renderer_;
    std::vector<std::pair<std::uint32_t, WobblePass>> waves_;  // of deforming meshes
    double pressed_ = 0.0;                                     // time up to which footprints exist, seconds
    bool drawn_before_ = false;
};

}  // namespace relief
