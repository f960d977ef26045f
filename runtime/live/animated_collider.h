// SPDX-License-Identifier: Apache-2.0
// A collider animated by glTF clips or by the program: a character, a machine. Its mesh is posed on the GPU
// (skin_pass.h) and rendered into the maps of a LiveCollider, whose box moves with it:
//
//     AnimatedCollider walker = *AnimatedCollider::create(mesh);
//     ColliderBody body{.collider = &walker.frames(), .pose = walker.placed(pose), .live = true};
//     WorldTextures textures = *WorldTextures::create({&body, 1});   // other bodies may be added
//     each step:  walker.setPose(poseAt(*mesh, clip, time));         // pose at the end of the step
//                 textures.setPoses({walker.placed(pose), …});
//                 walker.update(textures, 0);
//                 particles.step(dt);
//
// The maps cover the largest extent of any pose, not the whole path. The box has a constant size. On the GPU its
// centre, middle(), is the origin; placed() accounts for this offset.
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

/// Returns liveMaps() around the origin for a mesh whose poses fit into a box of this size. Space around the mesh
/// counts as outside.
/// \param box_size  object units, see poseExtent(). Errors: those of liveMaps().
[[nodiscard]] Result<Collider> animatedMaps(const glm::vec3& box_size, std::uint32_t resolution);

struct AnimatedColliderOptions {
    std::uint32_t resolution = 512;  ///< texels along the longest side of the box
    /// Sides of a box that contains every pose, object units; nullopt: PoseExtent::box_size of the mesh.
    std::optional<glm::vec3> box_size{};
};

class AnimatedCollider {
  public:
    /// Starts in firstPose(). Every call except check(), settle(), placed() and the accessors needs a current context,
    /// restores the GL state that it changes, and does not wait.
    /// \param mesh  valid; may be shared by several colliders.
    /// Errors: those of animatedMaps(), LiveCollider and SkinPass.
    [[nodiscard]] static Result<AnimatedCollider> create(std::shared_ptr<const AnimatedMesh> mesh,
                                                         const AnimatedColliderOptions& options = {});

    /// Checks a pose. Errors: kUsage (wrong number of joints or weights, a number that is not finite, a pose that
    /// exceeds the box).
    [[nodiscard]] Result<void> check(const MeshPose& pose) const;
    /// Moves the vertices; update() renders them. Call it at most once between two updates.
    /// Errors: those of check(); kUsage (called twice). The state is then unchanged.
    [[nodiscard]] Result<void> setPose(const MeshPose& pose);
    /// Treats the last setPose() as a jump (LiveCollider::settle()). If the body jumps, call WorldTextures::setPoses()
    /// twice.
    void settle() { live_.settle(); }

    /// Returns the pose of the centre of the box, for WorldTextures. \param body  pose of the mesh's origin.
    [[nodiscard]] Pose placed(const Pose& body) const;

    /// Calls LiveCollider::update().
    [[nodiscard]] Result<void> update(WorldTextures& textures, std::size_t body) {
        return live_.update(textures, body);
    }

    [[nodiscard]] const AnimatedMesh& mesh() const { return *mesh_; }
    [[nodiscard]] const std::shared_ptr<const AnimatedMesh>& shared() const { return mesh_; }
    [[nodiscard]] const LiveCollider& live() const { return live_; }
    [[nodiscard]] const Collider& frames() const { return live_.frames(); }
    [[nodiscard]] const glm::vec3& middle() const { return middle_; }  ///< centre of the box, object space

  private:
    AnimatedCollider(std::shared_ptr<const AnimatedMesh> mesh, const glm::vec3& box_size, SkinPass pass,
                     LiveCollider live)
        : mesh_(std::move(mesh)),
          bounds_(*mesh_),
          box_size_(box_size),
          pass_(std::move(pass)),
          live_(std::move(live)) {}

    std::shared_ptr<const AnimatedMesh> mesh_;
    PoseBounds bounds_;
    glm::vec3 box_size_;
    SkinPass pass_;
    LiveCollider live_;
    std::optional<MeshPose> pose_;  // the last pose set
    glm::vec3 middle_{0.0F};
};

}  // namespace relief
