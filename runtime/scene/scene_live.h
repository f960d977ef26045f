// A scene's collider that deforms: a mesh instead of a container, how it moves, and what its maps are.
#pragma once

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/collider/deformation.h"
#include "runtime/picture/picture_mesh.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// The mesh of a live collider, ready to deform.
struct LiveMesh {
    /// One normal a vertex, so that a wobble tears nothing.
    PictureMesh mesh;
    Deformation deformation;  ///< complete
    Collider frames;          ///< bounds of the whole motion, and three maps without texels
};

/// With angles in radians; what the scene leaves open is not filled in.
[[nodiscard]] Deformation deformationOf(const SceneLive& live);

/// Reads the mesh, completes its deformation, and chooses maps that hold its whole motion.
/// \param from  with `live`.
/// Fails as loadPictureMesh does, and with kInvalidInput (a mesh without extent); messages begin with the place in the scene.
[[nodiscard]] Result<LiveMesh> loadLiveMesh(const SceneCollider& from);

}  // namespace relief
