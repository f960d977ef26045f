// SPDX-License-Identifier: Apache-2.0
#include "runtime/live/animated_collider.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <string>
#include <utility>

namespace relief {
namespace {

/// Tolerance for rounding of a box, relative to its sides.
constexpr float kRoomSlack = 1e-5F;

bool isFinite(const MeshPose& pose) {
    const auto numbers = [](const glm::vec4& row) { return std::isfinite(row.x + row.y + row.z + row.w); };
    return std::all_of(pose.joints.begin(), pose.joints.end(),
                       [&](const Affine& joint) { return std::all_of(joint.row, joint.row + 3, numbers); }) &&
           std::all_of(pose.weights.begin(), pose.weights.end(),
                       [](float weight) { return std::isfinite(weight); });
}

std::string sidesText(const glm::vec3& sides) {
    return std::to_string(sides.x) + " x " + std::to_string(sides.y) + " x " + std::to_string(sides.z);
}

}  // namespace

Result<Collider> animatedMaps(const glm::vec3& box_size, std::uint32_t resolution) {
    Collider frames =
        RELIEF_TRY(liveMaps({-0.5F * box_size, 0.5F * box_size}, resolution, LiveSize::kSquareTexels));
    for (DepthMap& map : frames.maps) {
        map.encloses = true;
        map.empty_is_outside = true;
    }
    return frames;
}

Result<AnimatedCollider> AnimatedCollider::create(std::shared_ptr<const AnimatedMesh> mesh,
                                                  const AnimatedColliderOptions& options) {
    const glm::vec3 box_size = options.box_size ? *options.box_size : poseExtent(*mesh).box_size;
    Collider frames = RELIEF_TRY(animatedMaps(box_size, options.resolution));
    SkinPass pass = RELIEF_TRY(SkinPass::create(*mesh));
    // Any initial positions are valid: setPose() replaces all of them before the first render.
    LiveCollider live = RELIEF_TRY(LiveCollider::create(mesh->positions, mesh->triangles, std::move(frames)));
    AnimatedCollider made(std::move(mesh), box_size, std::move(pass), std::move(live));
    RELIEF_TRY(made.setPose(firstPose(*made.mesh_)));
    return made;
}

Result<void> AnimatedCollider::check(const MeshPose& pose) const {
    if (pose.joints.size() != mesh_->joints.size() || pose.weights.size() != mesh_->weights.size()) {
        return fail(ErrorCode::kUsage, "a pose of " + std::to_string(pose.joints.size()) + " joints and " +
                                           std::to_string(pose.weights.size()) +
                                           " morph weights was given to a mesh of " +
                                           std::to_string(mesh_->joints.size()) + " joints and " +
                                           std::to_string(mesh_->weights.size()) + " morph weights");
    }
    if (!isFinite(pose)) {
        return fail(ErrorCode::kUsage, "the pose of an animated collider is not finite");
    }
    const Bounds box = bounds_.of(pose);
    if (!glm::all(glm::lessThanEqual(
            box.size(), box_size_ + kRoomSlack * std::max({box_size_.x, box_size_.y, box_size_.z})))) {
        return fail(ErrorCode::kUsage, "a pose occupies " + sidesText(box.size()) +
                                           ", more than the box of the animated collider, " +
                                           sidesText(box_size_) + "; create it with a larger box");
    }
    return {};
}

Result<void> AnimatedCollider::setPose(const MeshPose& pose) {
    if (pose == pose_) {
        return {};
    }
    RELIEF_TRY(check(pose));
    const glm::vec3 middle = bounds_.of(pose).center();
    pass_.run(pose, middle);
    RELIEF_TRY(live_.setPositions(pass_.buffer().name()));
    middle_ = middle;
    pose_ = pose;
    return {};
}

Pose AnimatedCollider::placed(const Pose& body) const {
    return {toWorld(body, middle_), body.rotation, body.scale};
}

}  // namespace relief
