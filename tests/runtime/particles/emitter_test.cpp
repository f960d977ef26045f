#include "runtime/particles/emitter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace relief {
namespace {

EmitterSettings snow() {
    EmitterSettings settings;
    settings.box_min = {-1.0F, 2.0F, 5.0F};
    settings.box_max = {3.0F, 2.5F, 5.0F};  // flat along z
    settings.rate = 1000.0;
    settings.velocity = {0.0F, -2.0F, 1.0F};
    settings.velocity_spread = {0.5F, 0.0F, 2.0F};
    settings.lifetime_min = 3.0F;
    settings.lifetime_max = 7.0F;
    settings.type = 5;
    return settings;
}

// The first outputs of O'Neill's pcg32_random_r demo program (seed 42, sequence 54).
TEST(Pcg32, IsThePublishedGenerator) {
    Pcg32 random(42, 54);
    for (const std::uint32_t expected :
         {0xa15c02b7U, 0x7b47f409U, 0xba1d3330U, 0x83d2f293U, 0xbfa4784bU, 0xcbed606eU}) {
        EXPECT_EQ(random.next(), expected);
    }
}

TEST(Emitter, SameSeedSameBirthsHoweverTimeIsCut) {
    Emitter a(snow(), 7);
    Emitter b(snow(), 7);
    Emitter other(snow(), 8);
    std::vector<Birth> of_a;
    std::vector<Birth> of_b;
    std::vector<Birth> of_other;
    for (int i = 0; i < 64; ++i) {
        a.emit(1.0 / 32.0, 1'000'000, of_a);
    }
    for (int i = 0; i < 16; ++i) {
        b.emit(1.0 / 8.0, 1'000'000, of_b);
        other.emit(1.0 / 8.0, 1'000'000, of_other);
    }
    ASSERT_EQ(of_a.size(), 2000U);
    ASSERT_EQ(of_b.size(), 2000U);
    int same = 0;
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        ASSERT_EQ(of_a[i].position, of_b[i].position);
        ASSERT_EQ(of_a[i].velocity, of_b[i].velocity);
        ASSERT_EQ(of_a[i].lifetime, of_b[i].lifetime);
        same += of_a[i].position == of_other[i].position ? 1 : 0;
    }
    EXPECT_LT(same, 3);
}

// Pins the bits: a change of generator, order or arithmetic would change every seeded run.
TEST(Emitter, FirstBirthIsPinned) {
    Emitter emitter(snow(), 1);
    std::vector<Birth> births;
    emitter.emit(0.001, 10, births);
    ASSERT_EQ(births.size(), 1U);
    Pcg32 random(1);
    const auto u = [&] { return static_cast<float>(random.next() >> 8) * 0x1p-24F; };
    const float x = u();
    EXPECT_EQ(births[0].position.x, (1.0F - x) * -1.0F + x * 3.0F);
    EXPECT_EQ(births[0].type, 5U);
}

TEST(Emitter, RateBurstAndSteadiness) {
    EmitterSettings settings = snow();
    settings.burst = 50;
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    // 60 steps of a dt that is no binary fraction make exactly one second's births.
    for (int second = 1; second <= 20; ++second) {
        for (int step = 0; step < 60; ++step) {
            emitter.emit(1.0 / 60.0, 1'000'000, births);
        }
        ASSERT_EQ(births.size(), 50U + 1000U * static_cast<unsigned>(second));
    }
}

TEST(Emitter, DurationEndsTheBirths) {
    EmitterSettings settings = snow();
    settings.duration = 1.5;
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    for (int step = 0; step < 300; ++step) {
        emitter.emit(1.0 / 60.0, 1'000'000, births);
    }
    EXPECT_EQ(births.size(), 1500U);
}

TEST(Emitter, NoRoomIsCountedAndNotMadeUpFor) {
    Emitter emitter(snow(), 1);
    std::vector<Birth> births;
    EXPECT_EQ(emitter.emit(1.0, 300, births), 700U);
    EXPECT_EQ(births.size(), 300U);
    EXPECT_EQ(emitter.emit(1.0, 5000, births), 0U);
    EXPECT_EQ(births.size(), 1300U);
}

TEST(Emitter, AnAbsurdRateTakesNoMoreThanThereIsRoomFor) {
    EmitterSettings settings = snow();
    settings.rate = 1e300;
    settings.burst = 0xffffffffffffU;
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    emitter.emit(1e300, 10, births);
    emitter.emit(1e300, 10, births);
    EXPECT_LE(births.size(), 20U);
}

// Mean and variance of a uniform distribution, within five standard errors, and its exact ends.
TEST(Emitter, IsUniformInBoxSpeedAndLifetime) {
    Emitter emitter(snow(), 3);
    std::vector<Birth> births;
    constexpr int kCount = 200'000;
    emitter.emit(kCount / 1000.0, kCount, births);
    ASSERT_EQ(births.size(), static_cast<std::size_t>(kCount));
    const auto check = [&](auto value, double low, double high) {
        double sum = 0.0;
        double squares = 0.0;
        for (const Birth& birth : births) {
            const double x = static_cast<double>(value(birth));
            ASSERT_GE(x, low);
            ASSERT_LE(x, high);
            sum += x;
            squares += x * x;
        }
        const double mean = sum / kCount;
        const double width = high - low;
        EXPECT_NEAR(mean, 0.5 * (low + high), 5.0 * width / std::sqrt(12.0 * kCount));
        EXPECT_NEAR(squares / kCount - mean * mean, width * width / 12.0,
                    5.0 * width * width / std::sqrt(180.0 * kCount));
    };
    check([](const Birth& b) { return b.position.x; }, -1.0, 3.0);
    check([](const Birth& b) { return b.position.y; }, 2.0, 2.5);
    check([](const Birth& b) { return b.velocity.x; }, -0.5, 0.5);
    check([](const Birth& b) { return b.velocity.z; }, -1.0, 3.0);
    check([](const Birth& b) { return b.lifetime; }, 3.0, 7.0);
    for (const Birth& birth : births) {
        ASSERT_EQ(birth.position.z, 5.0F);
        ASSERT_EQ(birth.velocity.y, -2.0F);
    }
}

}  // namespace
}  // namespace relief
