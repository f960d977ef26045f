// SPDX-License-Identifier: Apache-2.0
// Camera paths pass through their keys, and always have an up vector.
#include "runtime/picture/camera_path.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace relief {
namespace {

const std::array<CameraKey, 3> kKeys{CameraKey{1.0, {0.0F, 0.0F, 5.0F}, {0.0F, 0.0F, 0.0F}, 30.0F},
                                     CameraKey{2.0, {2.0F, 1.0F, 5.0F}, {1.0F, 0.0F, 0.0F}, 50.0F},
                                     CameraKey{5.0, {8.0F, 4.0F, 5.0F}, {4.0F, 0.0F, 0.0F}, 20.0F}};

TEST(CameraPath, PassesThroughItsKeysAndRestsOutside) {
    for (const CameraKey& key : kKeys) {
        const Camera camera = cameraAt(kKeys, key.time);
        EXPECT_EQ(camera.eye, key.eye);
        EXPECT_EQ(camera.target, key.target);
        EXPECT_EQ(camera.fov, key.fov);
    }
    EXPECT_EQ(cameraAt(kKeys, -7.0), cameraAt(kKeys, 1.0));
    EXPECT_EQ(cameraAt(kKeys, 1e9), cameraAt(kKeys, 5.0));
}

// These keys lie on straight lines in time (2 and 1 per second along x and y). Catmull-Rom with speeds by time
// reproduces the lines although the keys are 1 and 3 seconds apart; by index it would not.
TEST(CameraPath, SmoothKeepsConstantSpeed) {
    for (const double time : {1.25, 1.75, 2.5, 3.5, 4.9}) {
        const auto t = static_cast<float>(time);
        const Camera camera = cameraAt(kKeys, time);
        EXPECT_NEAR(camera.eye.x, 2.0F * (t - 1.0F), 1e-5F);
        EXPECT_NEAR(camera.eye.y, t - 1.0F, 1e-5F);
        EXPECT_NEAR(camera.eye.z, 5.0F, 1e-5F);
    }
}

// Uniform keys 0, 0, 1, 1: halfway through the middle segment, Catmull-Rom's weights are (-1, 9, 9, -1)/16.
TEST(CameraPath, SmoothIsCatmullRom) {
    std::array<CameraKey, 4> keys{};
    const std::array<float, 4> x{3.0F, 0.0F, 1.0F, 7.0F};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        keys[i] = {static_cast<double>(i), {x[i], 0.0F, 9.0F}, glm::vec3(0.0F), 30.0F};
    }
    EXPECT_NEAR(cameraAt(keys, 1.5).eye.x, (-3.0F + 0.0F + 9.0F - 7.0F) / 16.0F, 1e-6F);
    // Speed is continuous at a key.
    const auto at = [&](double time) { return cameraAt(keys, time).eye.x; };
    EXPECT_NEAR((at(2.001) - at(2.0)) / 0.001F, (at(2.0) - at(1.999)) / 0.001F, 0.05F);
    EXPECT_NEAR((at(2.001) - at(1.999)) / 0.002F, 0.5F * (x[3] - x[1]), 0.05F);
}

TEST(CameraPath, OneKeyAndHardTurns) {
    const std::array<CameraKey, 1> one{kKeys[1]};
    EXPECT_EQ(cameraAt(one, 0.0).eye, kKeys[1].eye);
    EXPECT_EQ(cameraAt(one, 9.0).eye, kKeys[1].eye);
    // Directly above the target, and through it.
    for (const float height : {4.0F, 0.0F}) {
        const std::array<CameraKey, 2> over{CameraKey{0.0, {-1.0F, height, 0.0F}, glm::vec3(0.0F), 30.0F},
                                            CameraKey{1.0, {1.0F, height, 0.0F}, glm::vec3(0.0F), 30.0F}};
        const Camera camera = cameraAt(over, 0.5);
        EXPECT_TRUE(std::isfinite(camera.up().x + camera.right().x)) << height;
        EXPECT_NEAR(glm::length(camera.up()), 1.0F, 1e-3F);
    }
    // Between steep keys the cubic leaves the range of angles; the camera must not.
    const std::array<CameraKey, 4> wide{
        CameraKey{0.0, glm::vec3(1.0F), {}, 1.0F}, CameraKey{1.0, glm::vec3(1.0F), {}, 169.0F},
        CameraKey{2.0, glm::vec3(1.0F), {}, 170.0F}, CameraKey{3.0, glm::vec3(1.0F), {}, 1.0F}};
    for (int i = 0; i <= 300; ++i) {
        const float fov = cameraAt(wide, 0.01 * i).fov;
        EXPECT_GE(fov, 1.0F);
        EXPECT_LE(fov, 170.0F);
    }
}

}  // namespace
}  // namespace relief
