// SPDX-License-Identifier: Apache-2.0
#include "runtime/births/emitter_motion.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "formats/base/finite.h"

namespace relief {
namespace {

/// Transforms a birth from the moving space of a trajectory into the space of its poses.
/// \param moved  accumulates the motion of the emitting point; births finally inherit a fraction of it.
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

void carry(const EmitterMotion& motion, double time, std::span<Birth> births, std::span<const glm::vec3> own,
           std::vector<glm::vec3>* velocities) {
    if (velocities != nullptr) {
        velocities->assign(births.size(), glm::vec3(0.0F));
    }
    if (motion.none() && own.empty()) {
        return;
    }
    for (std::size_t i = 0; i < births.size(); ++i) {
        Birth& birth = births[i];
        const double moment = time - static_cast<double>(birth.age);
        glm::vec3 moved = own.empty() ? glm::vec3(0.0F) : own[i];
        carryAlong(motion.keys, moment, birth, moved);
        carryAlong(motion.body, moment, birth, moved);
        if (velocities != nullptr) {
            (*velocities)[i] = moved;
        }
        // A step of zero length may produce a motion that is not finite.
        const glm::vec3 velocity = birth.velocity + motion.inherit * moved;
        birth.velocity = isFinite(velocity) ? velocity : birth.velocity;
    }
}

namespace {

/// Transforms an emitter's births from `first` on. Removes births that its filter rejects or that exceed the room.
/// \return the number of births that exceeded the room.
std::uint64_t carryFiltered(const EmitterMotion& motion, double time, const Emitter& emitter,
                            std::uint64_t room, std::size_t first, std::vector<Birth>& births) {
    const std::span<Birth> made = std::span(births).subspan(first);
    std::vector<glm::vec3> velocities;
    carry(motion, time, made, emitter.birthSurfaceVelocities(), &velocities);
    const std::vector<bool> stays = motion.filter(made, velocities, time);
    std::uint64_t rejected = 0;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < made.size(); ++i) {
        if (!stays[i]) {
            continue;
        }
        if (kept < room) {
            made[kept++] = made[i];
        } else {
            ++rejected;
        }
    }
    births.resize(first + kept);
    return rejected;
}

}  // namespace

std::uint64_t emitAll(std::span<Emitter> emitters, double dt, std::uint64_t room, std::vector<Birth>& births,
                      std::span<const EmitterMotion> motions, double time) {
    std::uint64_t rejected = 0;
    for (std::size_t i = 0; i < emitters.size(); ++i) {
        const std::size_t before = births.size();
        if (i < motions.size() && motions[i].filter) {
            rejected += emitters[i].emit(dt, kFilteredMax, births);
            rejected += carryFiltered(motions[i], time, emitters[i], room, before, births);
        } else {
            rejected += emitters[i].emit(dt, room, births);
            if (i < motions.size()) {
                carry(motions[i], time, std::span(births).subspan(before),
                      emitters[i].birthSurfaceVelocities());
            }
        }
        room -= births.size() - before;
    }
    return rejected;
}

}  // namespace relief
