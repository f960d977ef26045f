// SPDX-License-Identifier: Apache-2.0
// A scene's collider that wobbles: a mesh instead of a container, how it moves, and what its maps are.
#pragma once

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/picture_mesh.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// The mesh of a live collider, ready to wobble.
struct LiveMesh {
    PictureMesh mesh;  ///< with one normal a vertex, so that waves tear nothing
    Wobble wobble;
    Collider frames;  ///< bounds of the whole motion, and three maps without texels
};

/// Reads the mesh, completes its wobble, and chooses maps that hold its whole motion.
/// \param from  with `live`.
/// Fails as loadPictureMesh does, and with kInvalidInput (a mesh without extent); messages begin with the place in the scene.
[[nodiscard]] Result<LiveMesh> loadLiveMesh(const SceneCollider& from);

}  // namespace relief
