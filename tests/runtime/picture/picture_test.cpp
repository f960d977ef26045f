// SPDX-License-Identifier: Apache-2.0
// PNG and PLY bytes, read back by libpng or checked by hand; camera paths; and key frames of looks, which
// sprite_gl_test.cpp draws.
#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "runtime/files/ply.h"
#include "runtime/files/png.h"
#include "runtime/picture/camera_path.h"
#include "runtime/picture/particle_look.h"
#include "tests/results.h"

namespace relief::test {
namespace {

TEST(Png, RejectsWrongSizes) {
    const std::vector<std::uint8_t> rgb(12);
    for (const auto& [width, height] :
         {std::pair{0U, 4U}, {4U, 0U}, {2U, 3U}, {70000U, 1U}, {0xffffffffU, 0xffffffffU}}) {
        expectError(encodePng(rgb, width, height), ErrorCode::kUsage);
    }
    EXPECT_TRUE(encodePng(rgb, 2, 2));
}

TEST(Png, LibpngReadsTheFileBack) {
    constexpr std::uint32_t kWidth = 37;
    constexpr std::uint32_t kHeight = 11;
    std::vector<std::uint8_t> rgb;
    std::vector<std::uint8_t> rgba;
    for (std::size_t i = 0; i < std::size_t{3} * kWidth * kHeight; ++i) {
        rgba.push_back(rgb.emplace_back(static_cast<std::uint8_t>(i * 7 + i / 256)));
        if (i % 3 == 2) {
            rgba.push_back(255);
        }
    }
    const std::vector<std::byte> bytes = required(encodePng(rgb, kWidth, kHeight));
    EXPECT_EQ(*encodePng(rgb, kWidth, kHeight), bytes) << "the same pixels must give the same bytes";
    const auto picture = required(decodePng(bytes, "'a.png'"));
    EXPECT_EQ(picture.width, kWidth);
    EXPECT_EQ(picture.rgba, rgba);
    for (std::size_t i = 0; i + 13 < bytes.size(); ++i) {  // only the end mark may be missing
        expectError(decodePng(std::span(bytes).first(i), "'a.png'"), ErrorCode::kInvalidInput);
    }
    const std::vector<std::uint8_t> row(std::size_t{3} * (kPngReadSideMax + 1));
    EXPECT_EQ(decodePng(*encodePng(row, kPngReadSideMax + 1, 1), "'a.png'").error().code, ErrorCode::kLimit);
}

TEST(Ply, HeaderAndVerticesMatchTheFormat) {
    std::vector<ParticleState> particles(2);
    particles[0] = {.id = 0x01020304,
                    .position = {1.0F, -2.0F, 0.5F},
                    .velocity = {4.0F, 5.0F, 6.0F},
                    .age = 0.25F,
                    .lifetime = 8.0F,
                    .type = 0x0a0b0c};
    particles[1].id = 3;  // lower: comes first
    const auto ply = [](const std::vector<ParticleState>& states) {
        const std::vector<std::byte> bytes = encodePly(states);
        return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    };
    const std::string text = ply(particles);
    const std::string head =
        "ply\nformat binary_little_endian 1.0\ncomment particles of relief-sim; object units, seconds\n"
        "element vertex 2\nproperty float x\nproperty float y\nproperty float z\nproperty float vx\n"
        "property float vy\nproperty float vz\nproperty float age\nproperty float lifetime\nproperty uint "
        "id\nproperty uint type\nend_header\n";
    ASSERT_EQ(text.size(), head.size() + 2 * 40);
    EXPECT_EQ(text.substr(0, head.size()), head);
    EXPECT_EQ(text[head.size() + 32], 3);
    // Little-endian: 1.0F is 3f 80 00 00.
    EXPECT_EQ(text.substr(head.size() + 40, 4), std::string("\0\0\x80\x3f", 4));
    EXPECT_EQ(text.substr(head.size() + 72), std::string("\4\3\2\1\x0c\x0b\x0a\0", 8));
    EXPECT_TRUE(ply({}).ends_with("end_header\n")) << "a file without particles is valid";
}

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

TEST(ParticleLook, TracksHaveTheirOwnAges) {
    ParticleLook look;
    for (std::size_t i = 0; i < kLookKeysMax; ++i) {
        const auto age = [&](float shift) { return (static_cast<float>(i) + shift) / kLookKeysMax; };
        look.size.push_back({age(0.0F), 1.0F});
        look.opacity.push_back({age(0.25F), 1.0F});
        look.rotation.push_back({age(0.5F), 1.0F});
        look.color.push_back({age(0.75F), glm::vec3(1.0F)});
    }
    const auto packed = required(packLooks(std::vector<ParticleLook>{look}, {}));
    EXPECT_EQ(packed.texels[1].w, 4.0F * kLookKeysMax);
    EXPECT_EQ(packed.texels.back(), glm::vec4(1.0F, 1.0F, 1.0F, 0.0F)) << "the row is full";
    EXPECT_LE(packed.width, 2048U) << "larger than OpenGL ES 3.0 guarantees";
}

TEST(ParticleLook, InvalidTracksAreRejected) {
    const auto refused = [](const auto& change) {
        ParticleLook look;
        change(look);
        const auto texels = packLooks(std::vector<ParticleLook>{look}, {});
        return !texels && texels.error().code == ErrorCode::kUsage;
    };
    EXPECT_FALSE(refused([](ParticleLook&) {}));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.size.resize(kLookKeysMax + 1); }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.size = {{0.5F, 1.0F}, {0.5F, 1.0F}}; }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.color = {{0.5F, {}}, {0.2F, {}}}; }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.opacity = {{1.1F, 1.0F}}; }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.opacity = {{0.0F, 1.1F}}; }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.size = {{0.0F, -1.0F}}; }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.color = {{0.0F, {0.0F, 2.0F, 0.0F}}}; }));
    EXPECT_TRUE(refused([](ParticleLook& l) {
        l.rotation = {{0.0F, std::numeric_limits<float>::quiet_NaN()}};
    }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.spin_spread = std::numeric_limits<float>::infinity(); }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.stretch = -1.0F; }));
    EXPECT_TRUE(refused([](ParticleLook& l) { l.cell_first = 2; }));
    EXPECT_FALSE(packLooks(std::vector<ParticleLook>(kLooksMax + 1), {}));
    EXPECT_TRUE(packLooks(std::vector<ParticleLook>(kLooksMax), {}));
}

}  // namespace
}  // namespace relief::test
