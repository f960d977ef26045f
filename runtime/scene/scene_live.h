// SPDX-License-Identifier: Apache-2.0
// Colliders of a scene that deform in waves (collider.deform): a mesh instead of a container.
#pragma once

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/picture_mesh.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// The mesh of a live collider and its waves.
struct LiveMesh {
    PictureMesh mesh;  ///< with one normal per vertex, so that waves do not tear it
    Wobble wobble;
    Collider frames;  ///< bounds of the whole motion, and three maps without texels
};

/// Reads the mesh, completes its waves, and chooses maps that cover its whole motion.
/// \param from  with `live`.
/// Errors: those of loadPictureMesh(); kInvalidInput (a mesh without extent). Messages start with the place in the
/// scene.
[[nodiscard]] Result<LiveMesh> loadLiveMesh(const SceneCollider& from);

}  // namespace relief
