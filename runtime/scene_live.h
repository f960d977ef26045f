// A scene's collider that deforms: a mesh instead of a container, how it moves, and what its maps are.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <vector>

#include "formats/collider.h"
#include "formats/result.h"
#include "runtime/deformation.h"
#include "runtime/picture_mesh.h"

namespace relief {

struct SceneCollider;

/// What [collider] says of `mesh` and `deform`; what is left open depends on the mesh.
struct SceneLive {
    Deformation deformation;
    bool has_center = false;      ///< else the middle of the mesh's box
    bool has_range = false;       ///< else the mesh's whole extent along the axis, or along `along`
    bool has_wavelength = false;  ///< else half of the box's longest side
    std::uint32_t resolution = 256;
};

/// The mesh of a live collider, ready to deform.
struct LiveMesh {
    /// One normal a vertex, so that a wobble tears nothing.
    PictureMesh mesh;
    Deformation deformation;  ///< complete
    Collider frames;          ///< bounds of the whole motion, and three maps without texels
};

/// Reads the mesh, completes its deformation, and chooses maps that hold its whole motion.
/// \param from  with `live`. Errors: those of loadMesh, and kInvalidInput (a mesh without extent), all with
/// the place in the scene.
[[nodiscard]] Result<LiveMesh> loadLiveMesh(const SceneCollider& from);

}  // namespace relief
