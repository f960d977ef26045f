// SPDX-License-Identifier: Apache-2.0
// Key frames: rows for the shader, and rejected values. sprite_gl_test.cpp draws them.
#include "runtime/picture/particle_look.h"

#include <gtest/gtest.h>

#include <limits>

namespace relief {
namespace {

TEST(ParticleLook, TracksHaveTheirOwnAges) {
    ParticleLook look;
    for (std::size_t i = 0; i < kLookKeysMax; ++i) {
        const auto age = [&](float shift) { return (static_cast<float>(i) + shift) / kLookKeysMax; };
        look.size.push_back({age(0.0F), 1.0F});
        look.opacity.push_back({age(0.25F), 1.0F});
        look.rotation.push_back({age(0.5F), 1.0F});
        look.color.push_back({age(0.75F), glm::vec3(1.0F)});
    }
    const auto texels = packLooks(std::vector<ParticleLook>{look}, {});
    ASSERT_TRUE(texels) << texels.error().message;
    EXPECT_EQ(texels->texels[1].w, 4.0F * kLookKeysMax);
    EXPECT_EQ(texels->texels.back(), glm::vec4(1.0F, 1.0F, 1.0F, 0.0F)) << "the row is full";
    EXPECT_LE(texels->width, 2048U) << "larger than OpenGL ES 3.0 guarantees";
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
}  // namespace relief
