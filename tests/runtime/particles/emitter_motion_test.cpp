// Emitters that move: births lie where the emitter was at their own moment, and take on a share of its velocity.
#include "runtime/particles/emitter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <vector>

namespace relief {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const glm::vec3 kUp(0.0F, 1.0F, 0.0F);

/// Half a turn about y in 4 s, and 8 along x.
std::vector<PoseKey> spin() {
    return {{0.0, {}},
            {2.0, {{4.0F, 0.0F, 0.0F}, glm::angleAxis(0.5F * kPi, kUp), 1.0F}},
            {4.0, {{8.0F, 0.0F, 0.0F}, glm::angleAxis(kPi, kUp), 1.0F}}};
}

void expectNear(const glm::vec3& a, const glm::vec3& b, float bound, const char* what) {
    EXPECT_LT(glm::length(a - b), bound) << what << ": " << a.x << ' ' << a.y << ' ' << a.z;
}

TEST(EmitterMotion, NoneLeavesBirthsAlone) {
    Birth birth{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, 1.0F, 0, 0.01F};
    carry({}, 3.0, std::span(&birth, 1));
    EXPECT_EQ(birth.position, glm::vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(birth.velocity, glm::vec3(4.0F, 5.0F, 6.0F));
}

TEST(EmitterMotion, EachBirthIsCarriedAtItsOwnMoment) {
    EmitterMotion motion;
    motion.keys = spin();
    std::vector<Birth> births(2, Birth{{1.0F, 0.5F, 0.0F}, {0.0F, 0.0F, 3.0F}});
    births[1].age = 1.0F;
    carry(motion, 2.0, births);
    // At 2 s: a quarter about y takes x to -z, and z to x.
    expectNear(births[0].position, {4.0F, 0.5F, -1.0F}, 1e-5F, "place");
    expectNear(births[0].velocity, {3.0F, 0.0F, 0.0F}, 1e-5F, "velocity");
    const float h = std::sqrt(0.5F);
    expectNear(births[1].position, {2.0F + h, 0.5F, -h}, 1e-5F, "place a second before");
    expectNear(births[1].velocity, {3.0F * h, 0.0F, 3.0F * h}, 1e-5F, "velocity a second before");
}

TEST(EmitterMotion, InheritsAShareOfItsVelocity) {
    EmitterMotion motion;
    motion.keys = spin();
    motion.inherit = 0.5F;
    Birth birth{{1.0F, 0.5F, 0.0F}, {0.0F, 0.0F, 0.0F}};
    carry(motion, 0.0, std::span(&birth, 1));
    // 2 along x, and pi/4 a second about y of an arm along x: -pi/4 along z.
    expectNear(birth.velocity, {1.0F, 0.0F, -kPi / 8.0F}, 1e-5F, "velocity");
    Birth after{{1.0F, 0.5F, 0.0F}, {0.0F, 0.0F, 0.0F}};
    carry(motion, 9.0, std::span(&after, 1));
    EXPECT_EQ(after.velocity, glm::vec3(0.0F)) << "it rests";
}

// Both ways one upon the other: positions by hand, velocities by differences of them.
TEST(EmitterMotion, AnAttachedEmitterGoesWithItsBody) {
    EmitterMotion motion;
    motion.keys = spin();
    motion.body = {
        {1.0, {{0.0F, 1.0F, 0.0F}, glm::angleAxis(0.3F, glm::normalize(glm::vec3(1.0F, 0.0F, 1.0F))), 3.0F}},
        {3.0, {{1.0F, 5.0F, -2.0F}, glm::angleAxis(1.9F, glm::vec3(1.0F, 0.0F, 0.0F)), 3.0F}}};
    motion.inherit = 1.0F;
    const auto at = [&](double time) {
        Birth birth{{0.3F, -0.2F, 0.6F}, {0.0F, 0.0F, 0.0F}};
        carry(motion, time, std::span(&birth, 1));
        return birth;
    };
    for (const double time : {1.2, 1.7, 2.5}) {
        const glm::vec3 by_hand =
            toWorld(poseAt(motion.body, time), toWorld(poseAt(motion.keys, time), {0.3F, -0.2F, 0.6F}));
        expectNear(at(time).position, by_hand, 1e-5F, "place");
        const glm::vec3 measured = (at(time + 1e-3).position - at(time - 1e-3).position) / 2e-3F;
        expectNear(at(time).velocity, measured, 0.05F, "velocity");
    }
    // The scale of the body is one of places, not of speeds.
    motion.inherit = 0.0F;
    Birth birth{{}, {0.0F, 7.0F, 0.0F}};
    carry(motion, 2.0, std::span(&birth, 1));
    EXPECT_NEAR(glm::length(birth.velocity), 7.0F, 1e-5F);
}

// A jet by rate from a nozzle that goes round: all births lie on its circle, evenly, with no bands of steps.
TEST(EmitterMotion, AJetHasNoBands) {
    EmitterSettings settings;
    settings.box_min = settings.box_max = {2.0F, 0.0F, 0.0F};
    settings.rate = 960.0;
    EmitterMotion motion;
    motion.keys = spin();
    std::vector<Emitter> emitters{Emitter(settings, 1)};
    std::vector<Birth> births;
    for (int step = 0; step < 60; ++step) {
        emitAll(emitters, 1.0 / 60.0, 1000, births, std::span(&motion, 1), step / 60.0);
    }
    ASSERT_EQ(births.size(), 960U);
    for (std::size_t n = 32; n < births.size(); ++n) {
        // Birth n falls at (n + 1) / 960, a step of which lies before the step that it enters.
        const double moment = (static_cast<double>(n) + 1.0) / 960.0 - 1.0 / 60.0;
        expectNear(births[n].position, toWorld(poseAt(motion.keys, moment), {2.0F, 0.0F, 0.0F}), 2e-5F,
                   "place");
    }
}

}  // namespace
}  // namespace relief
