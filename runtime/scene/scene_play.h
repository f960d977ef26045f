// SPDX-License-Identifier: Apache-2.0
// A scene's collider that plays a clip of its container.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "formats/animation/mesh_pose.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// An animated mesh and the clip of it that a collider of a scene plays.
struct PlayedMesh {
    std::shared_ptr<const AnimatedMesh> mesh;
    std::optional<std::size_t> clip;  ///< of the mesh; nullopt: it has none, and rests
    bool cyclic = false;              ///< isCyclic()
    ScenePlay play;
    glm::vec3 room{0.0F};  ///< that its maps have, object units
    Collider frames;       ///< bounds of all clips, object space, and three maps without texels

    /// \param time  of the scene, seconds.
    [[nodiscard]] MeshPose poseAt(double time) const;
    /// Runs of the clip begun by then. From one to another it jumps, unless it is cyclic.
    [[nodiscard]] double run(double time) const;
};

/// Goes over to the clip, the start and the speed that `from` asks for. Fails as loadPlayedMesh(); nothing then changes.
[[nodiscard]] Result<void> changeClip(PlayedMesh& played, const SceneCollider& from);

/// Finds the clip, and chooses maps that hold any clip of the mesh.
/// \param from  with `play`. \param mesh  of its container. \param extent  poseExtent() of the mesh.
/// Errors: kInvalidInput (no such clip: the message lists those there are); they begin with the place in the scene.
[[nodiscard]] Result<PlayedMesh> loadPlayedMesh(const SceneCollider& from,
                                                std::shared_ptr<const AnimatedMesh> mesh,
                                                const PoseExtent& extent);

}  // namespace relief
