// SPDX-License-Identifier: Apache-2.0
// Pose keys: straight lines, constant rotation, and the velocities of both, checked by differences.
#include "runtime/bodies/pose_keys.h"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <vector>

namespace relief {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

Pose pose(const glm::vec3& position, const glm::vec3& axis, float angle) {
    return {position, glm::angleAxis(angle, glm::normalize(axis)), 2.0F};
}

std::vector<PoseKey> path() {
    return {{1.0, pose({0.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.0F)},
            {3.0, pose({4.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.5F * kPi)},
            {4.0, pose({4.0F, -1.0F, 2.0F}, {0.3F, 1.0F, -0.5F}, -2.5F)},
            {4.5, pose({4.0F, -1.0F, 2.0F}, {0.3F, 1.0F, -0.5F}, -2.5F)}};
}

TEST(PoseKeys, InterpolatesLinearlyAtConstantRotation) {
    const auto keys = path();
    EXPECT_EQ(poseAt(keys, -5.0), keys.front().pose);
    EXPECT_EQ(poseAt(keys, 1.0), keys.front().pose);
    EXPECT_EQ(poseAt(keys, 9.0), keys.back().pose);
    const Pose half = poseAt(keys, 2.0);
    EXPECT_EQ(half.position, glm::vec3(2.0F, 0.0F, 0.0F));
    EXPECT_EQ(half.scale, 2.0F);
    EXPECT_NEAR(glm::angle(half.rotation), 0.25F * kPi, 1e-6F);
}

TEST(PoseKeys, MotionMatchesTheClosedForm) {
    const Motion motion = motionAt(path(), 2.0);
    EXPECT_NEAR(glm::length(motion.velocity - glm::vec3(2.0F, 0.0F, 0.0F)), 0.0F, 1e-6F);
    EXPECT_NEAR(glm::length(motion.turn - glm::vec3(0.0F, 0.0F, 0.25F * kPi)), 0.0F, 1e-6F);
    for (const double time : {0.5, 4.2, 4.5, 9.0}) {
        EXPECT_EQ(motionAt(path(), time).velocity, glm::vec3(0.0F)) << time;
        EXPECT_LT(glm::length(motionAt(path(), time).turn), 1e-6F) << time;
    }
    EXPECT_EQ(motionAt(path(), 1.0).velocity, glm::vec3(2.0F, 0.0F, 0.0F))
        << "at a key, the motion of the next segment";
}

// A quarter turn by either of its two quaternions is the same rotation.
TEST(PoseKeys, RotatesTheShorterWay) {
    auto keys = path();
    keys[1].pose.rotation = -keys[1].pose.rotation;
    EXPECT_NEAR(motionAt(keys, 2.0).turn.z, 0.25F * kPi, 1e-6F);
    EXPECT_NEAR(glm::angle(poseAt(keys, 2.0).rotation), 0.25F * kPi, 1e-5F);
}

// Neither direction is shorter: the rotation follows the angles, however they are rounded.
TEST(PoseKeys, HalfTurnsFollowTheAngles) {
    for (const glm::vec3& axis : {glm::vec3(0.0F, 1.0F, 0.0F), glm::vec3(0.3F, 1.0F, -0.5F)}) {
        for (const auto& [from, to] :
             {std::pair{0.0F, 180.0F}, std::pair{0.0F, -180.0F}, std::pair{180.0F, 360.0F},
              std::pair{-90.0F, 90.0F}, std::pair{100.0F, -80.0F}, std::pair{33.0F, 213.0F},
              std::pair{540.0F, 360.0F}}) {
            const std::vector<PoseKey> keys = {{0.0, pose({}, axis, glm::radians(from))},
                                               {2.0, pose({}, axis, glm::radians(to))}};
            const Motion motion = motionAt(keys, 1.0);
            const glm::vec3 expected = glm::radians(0.5F * (to - from)) * glm::normalize(axis);
            EXPECT_LT(glm::length(motion.turn - expected), 1e-5F) << from << " to " << to;
            const glm::quat middle = glm::angleAxis(glm::radians(0.5F * (from + to)), glm::normalize(axis));
            EXPECT_NEAR(std::abs(glm::dot(poseAt(keys, 1.0).rotation, middle)), 1.0F, 1e-6F)
                << from << " to " << to;
        }
    }
}

// For any rotation, velocity + turn × arm is the change of a point's toWorld().
TEST(PoseKeys, MotionIsTheDerivativeOfThePose) {
    const auto keys = path();
    constexpr double kShort = 1e-3;
    const glm::vec3 q(0.7F, -0.4F, 1.1F);
    for (const double time : {1.25, 2.9, 3.25, 3.5, 3.9}) {
        const glm::vec3 before = toWorld(poseAt(keys, time - kShort), q);
        const glm::vec3 after = toWorld(poseAt(keys, time + kShort), q);
        const Pose now = poseAt(keys, time);
        const Motion motion = motionAt(keys, time);
        const glm::vec3 velocity = motion.velocity + glm::cross(motion.turn, toWorld(now, q) - now.position);
        const glm::vec3 measured = (after - before) / static_cast<float>(2.0 * kShort);
        EXPECT_LT(glm::length(velocity - measured), 5e-3F) << time;
    }
}

}  // namespace
}  // namespace relief
