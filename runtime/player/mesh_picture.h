// SPDX-License-Identifier: Apache-2.0
// The colliders of a scene as pictures show them: by the meshes of render.meshes, along their clips and waves, under the
// scene's weather, with the prints that figures have left up to then.
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
    /// Fails as loadDrawnMeshes(), MeshRenderer and WobblePass do.
    [[nodiscard]] static Result<MeshPicture> create(const LoadedScene& loaded);

    /// Fills the target's colour and depth, with the sky where there is no mesh. Prints are of the time from the last call,
    /// or from the scene's beginning; an earlier one adds none.
    /// \param seconds  of the scene's time. Fails as MeshRenderer::draw() does.
    [[nodiscard]] Result<void> draw(const CameraMatrices& camera, double seconds, const RenderTarget& target);

    /// As MeshRenderer::depth().
    [[nodiscard]] const GlTexture& depth() const { return renderer_.depth(); }

  private:
    MeshPicture(const LoadedScene& loaded, DrawnMeshes drawn, MeshRenderer renderer)
        : loaded_(&loaded), drawn_(std::move(drawn)), renderer_(std::move(renderer)) {}

    [[nodiscard]] Result<void> pose(double seconds);
    [[nodiscard]] Result<void> press(double seconds);

    const LoadedScene* loaded_;
    DrawnMeshes drawn_;
    MeshRenderer renderer_;
    std::vector<std::pair<std::uint32_t, WobblePass>> waves_;  // of those that deform
    double pressed_ = 0.0;                                     // seconds up to which there are prints
    bool drawn_before_ = false;
};

}  // namespace relief
