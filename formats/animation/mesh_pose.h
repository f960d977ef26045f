// SPDX-License-Identifier: Apache-2.0
// Poses of an animated mesh: by a clip at a time, or by a program. CPU truth of shaders/live/skin.vert.
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
    /// One a joint of the mesh: from the space of the positions to object space (glTF's joint matrices).
    std::vector<Affine> joints;
    std::vector<float> weights;  ///< one a morph target
    friend bool operator==(const MeshPose&, const MeshPose&) = default;
};

/// The pose that the nodes have by themselves. \param mesh  valid, as that of every function here.
[[nodiscard]] MeshPose restPose(const AnimatedMesh& mesh);

/// The pose that its first clip begins with; at rest where it has none.
[[nodiscard]] MeshPose firstPose(const AnimatedMesh& mesh);

/// The pose of a clip. Before the first key of a channel its value holds, and after the last one that.
/// \param clip  of mesh.clips. \param seconds  finite
[[nodiscard]] MeshPose poseAt(const AnimatedMesh& mesh, const MeshClip& clip, double seconds);

/// The index of the clip of that name. \param name  "": the first. \return nullopt: there is none.
[[nodiscard]] std::optional<std::size_t> findClip(const AnimatedMesh& mesh, std::string_view name);

/// The time of a clip that runs round and round: in [0, clip.seconds). \param seconds  finite
[[nodiscard]] double repeated(const MeshClip& clip, double seconds);

/// Every vertex, object space.
/// \param pose  of as many joints and weights as the mesh has.
[[nodiscard]] std::vector<glm::vec3> posed(const AnimatedMesh& mesh, const MeshPose& pose);

/// Boxes of poses at the cost of their joints: each vertex lies between where its joints would put it, so in the box of its
/// joints' boxes.
class PoseBounds {
  public:
    explicit PoseBounds(const AnimatedMesh& mesh);

    /// A box, object space, that holds every vertex in that pose.
    [[nodiscard]] Bounds of(const MeshPose& pose) const;

  private:
    std::vector<Bounds> boxes_;     // of the vertices of each joint, in the space of the positions
    std::vector<glm::vec3> reach_;  // of each morph target: the most that it moves a vertex, along each axis
};

/// The space that a mesh takes up, by times of all its clips 1/240 s apart and 2 % more; of clips of hours these are farther apart.
struct PoseExtent {
    Bounds box;            ///< of all poses, object space
    glm::vec3 room{0.0F};  ///< sides of a box that holds any one of them
};
/// At rest, where arms are often spread, only if there is no clip.
[[nodiscard]] PoseExtent poseExtent(const AnimatedMesh& mesh);

/// The clip ends about where it began, so that repeating it is no jump.
[[nodiscard]] bool isCyclic(const AnimatedMesh& mesh, const MeshClip& clip);

}  // namespace relief
