#include "runtime/particles/emitter_motion.h"

#include <glm/gtc/quaternion.hpp>

namespace relief {
namespace {

/// From the space that moves along a trajectory to the space of its poses.
/// \param moved  how the place moves; `inherit` of it is taken on in the end.
void carryAlong(std::span<const PoseKey> keys, double time, Birth& birth, glm::vec3& moved) {
    if (keys.empty()) {
        return;
    }
    const Pose pose = poseAt(keys, time);
    const Motion motion = motionAt(keys, time);
    const glm::vec3 arm = pose.scale * (pose.rotation * birth.position);
    birth.position = pose.position + arm;
    birth.velocity = pose.rotation * birth.velocity;
    moved = motion.velocity + glm::cross(motion.turn, arm) + pose.scale * (pose.rotation * moved);
}

}  // namespace

void carry(const EmitterMotion& motion, double time, std::span<Birth> births) {
    if (motion.none()) {
        return;
    }
    for (Birth& birth : births) {
        const double moment = time - static_cast<double>(birth.age);
        glm::vec3 moved(0.0F);
        carryAlong(motion.keys, moment, birth, moved);
        carryAlong(motion.body, moment, birth, moved);
        birth.velocity += motion.inherit * moved;
    }
}

}  // namespace relief
