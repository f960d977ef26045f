// SPDX-License-Identifier: Apache-2.0
// Poses of an animated mesh, evaluated from a clip or set by the caller. CPU reference of shaders/live/skin.vert.
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <optional>
#include <string_view>
#include <vector>

#include "formats/animation/animated_mesh.h"
#include "formats/collider.h"

namespace relief {

struct MeshPose {
    /// One for each joint: from the space of the positions to object space (glTF's joint matrices).
    std::vector<Affine> joints;
    std::vector<float> weights;  ///< one for each morph target
    friend bool operator==(const MeshPose&, const MeshPose&) = default;
};

/// Returns the pose of the nodes' own transforms. All functions here require a valid mesh.
[[nodiscard]] MeshPose restPose(const AnimatedMesh& mesh);

/// Returns the start pose of the first clip; the rest pose if there are no clips.
[[nodiscard]] MeshPose firstPose(const AnimatedMesh& mesh);

/// Evaluates a clip. A channel holds its first value before its first key and its last value after its last key.
/// \param clip  one of mesh.clips. \param seconds  finite
[[nodiscard]] MeshPose poseAt(const AnimatedMesh& mesh, const MeshClip& clip, double seconds);

/// Returns the index of the clip with this name, or nullopt. \param name  "" selects the first clip.
[[nodiscard]] std::optional<std::size_t> findClip(const AnimatedMesh& mesh, std::string_view name);

/// Wraps a time into [0, clip.seconds) for looping. \param seconds  finite
[[nodiscard]] double repeated(const MeshClip& clip, double seconds);

/// Returns every vertex in object space.
/// \param pose  has as many joints and weights as the mesh.
[[nodiscard]] std::vector<glm::vec3> posed(const AnimatedMesh& mesh, const MeshPose& pose);

/// Computes the boxes of poses at a cost per joint, not per vertex: a skinned vertex is a convex combination of the
/// positions to which its joints move it, so it lies in the bounds of the transformed boxes of these joints.
class PoseBounds {
  public:
    explicit PoseBounds(const AnimatedMesh& mesh);

    /// Returns a box in object space that contains every vertex of the pose.
    [[nodiscard]] Bounds of(const MeshPose& pose) const;

  private:
    std::vector<Bounds> boxes_;     // each joint's vertices, in the space of the positions
    std::vector<glm::vec3> reach_;  // each morph target's largest displacement along each axis
};

/// The space that a mesh occupies, from samples of all clips 1/240 s apart, or farther apart in long clips.
struct PoseExtent {
    Bounds box;                ///< of all poses, object space
    glm::vec3 box_size{0.0F};  ///< largest size of a pose's box along each axis, plus 2 %
};
/// Excludes the rest pose if there is a clip, because characters often spread their arms only in the rest pose.
[[nodiscard]] PoseExtent poseExtent(const AnimatedMesh& mesh);

/// Returns whether the boxes of the clip's first and last pose are nearly equal, so that it can loop without a jump.
[[nodiscard]] bool isCyclic(const AnimatedMesh& mesh, const MeshClip& clip);

}  // namespace relief
