// SPDX-License-Identifier: Apache-2.0
// Colliders of a scene that deform: in waves (collider.deform), or by playing a clip (collider.play).
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "formats/animation/mesh_pose.h"
#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/picture_mesh.h"
#include "runtime/scene/scene_collider.h"

namespace relief {

/// The mesh of a collider that deforms in waves. Such a collider has no container.
struct LiveMesh {
    PictureMesh mesh;  ///< with one normal per vertex, so that waves do not tear it
    Wobble wobble;
    Collider frames;  ///< bounds of the whole motion, and three maps without texels
};

/// Reads the mesh, sets the default wavelength, and chooses maps that cover its whole motion.
/// \param from  its `live` must be set.
/// Errors: those of loadPictureMesh(); kInvalidInput (a mesh without extent). Messages start with the place in the
/// scene.
[[nodiscard]] Result<LiveMesh> loadLiveMesh(const SceneCollider& from);

/// An animated mesh, and the clip that a collider plays.
struct PlayedMesh {
    std::shared_ptr<const AnimatedMesh> mesh;
    std::optional<std::size_t> clip;  ///< nullopt: the mesh has no clips and rests
    bool cyclic = false;              ///< isCyclic()
    ScenePlay play;
    glm::vec3 box_size{0.0F};  ///< size of the box that the maps cover, object units
    Collider frames;           ///< bounds of all clips in object space, and three maps without texels

    /// Returns the pose at a time of the scene, seconds.
    [[nodiscard]] MeshPose poseAt(double time) const;
    /// Returns the number of the current run of the clip. The pose jumps between runs unless the clip is cyclic.
    [[nodiscard]] double run(double time) const;
};

/// Applies the clip, start, speed and loop of `from`. Errors: those of loadPlayedMesh(); `played` is then unchanged.
[[nodiscard]] Result<void> changeClip(PlayedMesh& played, const SceneCollider& from);

/// Finds the clip, and chooses maps that cover all clips of the mesh.
/// \param from  its `play` must be set. \param mesh  of its container. \param extent  poseExtent() of the mesh.
/// Errors: kInvalidInput (no such clip), with the place in the scene and a list of the clips.
[[nodiscard]] Result<PlayedMesh> loadPlayedMesh(const SceneCollider& from,
                                                std::shared_ptr<const AnimatedMesh> mesh,
                                                const PoseExtent& extent);

}  // namespace relief
