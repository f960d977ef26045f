// SPDX-License-Identifier: Apache-2.0
// A collider that moves as a glTF's clips, or the program, would have it: a character, a machine. Its mesh is posed on the
// GPU (skin_pass.h) and drawn into the maps of a LiveCollider, whose box goes with it:
//
//     AnimatedCollider walker = *AnimatedCollider::create(mesh);
//     ColliderBody body{.collider = &walker.frames(), .pose = walker.placed(pose), .live = true};
//     WorldTextures textures = *WorldTextures::create({&body, 1});   // other bodies may stand beside it
//     each step:  walker.setPose(poseAt(*mesh, clip, time));               // at the end of the step
//                 textures.setPoses({walker.placed(pose), …});
//                 walker.update(textures, 0);
//                 particles.step(dt);
//
// The maps cover as much as the mesh ever takes up, not the whole way that it goes: the box keeps its size, and its middle
// is the object's origin on the GPU. What placed() returns has that in it.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "formats/animation/mesh_pose.h"
#include "formats/base/result.h"
#include "formats/world/pose.h"
#include "runtime/live/live_collider.h"
#include "runtime/live/skin_pass.h"

namespace relief {

/// Maps for a mesh that takes up a box of these sides: liveFrames() about the origin, that know free space around the mesh.
/// \param room  object units, as poseExtent() finds it. Errors: as liveFrames().
[[nodiscard]] Result<Collider> animatedFrames(const glm::vec3& room, std::uint32_t resolution);

struct AnimatedColliderOptions {
    std::uint32_t resolution = 512;  ///< texels along the longest side of its box
    /// Sides of the box that holds it in every pose, object units; nullopt: that of poseExtent().
    std::optional<glm::vec3> room{};
};

class AnimatedCollider {
  public:
    /// Needs a current context, as every call but placed() does; every call restores the GL state that it touches, and none
    /// waits. It has its firstPose().
    /// \param mesh  valid; shared by all that move as it does.
    /// Fails as animatedFrames(), LiveCollider and SkinPass do.
    [[nodiscard]] static Result<AnimatedCollider> create(std::shared_ptr<const AnimatedMesh> mesh,
                                                         const AnimatedColliderOptions& options = {});

    /// Errors: kUsage (another number of joints or weights; a number that is not finite; a pose that takes up more than the
    /// room).
    [[nodiscard]] Result<void> check(const MeshPose& pose) const;
    /// Moves the vertices; update() shows it. Once between two updates.
    /// Fails as check(), and with kUsage (called twice). Nothing then changes.
    [[nodiscard]] Result<void> setPose(const MeshPose& pose);
    /// The last change was a jump: LiveCollider::settle(). Poses of the body are WorldTextures' own.
    void settle() { live_.settle(); }

    /// The pose to give to WorldTextures: that of the middle of its box. \param body  where the mesh's own origin is.
    [[nodiscard]] Pose placed(const Pose& body) const;

    /// LiveCollider::update().
    [[nodiscard]] Result<void> update(WorldTextures& textures, std::size_t body) {
        return live_.update(textures, body);
    }

    [[nodiscard]] const AnimatedMesh& mesh() const { return *mesh_; }
    [[nodiscard]] const std::shared_ptr<const AnimatedMesh>& shared() const { return mesh_; }
    [[nodiscard]] const LiveCollider& live() const { return live_; }
    [[nodiscard]] const Collider& frames() const { return live_.frames(); }
    [[nodiscard]] const glm::vec3& middle() const { return middle_; }  ///< of its box, object space

  private:
    AnimatedCollider(std::shared_ptr<const AnimatedMesh> mesh, const glm::vec3& room, SkinPass pass,
                     LiveCollider live)
        : mesh_(std::move(mesh)),
          bounds_(*mesh_),
          room_(room),
          pass_(std::move(pass)),
          live_(std::move(live)) {}

    std::shared_ptr<const AnimatedMesh> mesh_;
    PoseBounds bounds_;
    glm::vec3 room_;
    SkinPass pass_;
    LiveCollider live_;
    std::optional<MeshPose> pose_;  // the last
    glm::vec3 middle_{0.0F};
};

}  // namespace relief
