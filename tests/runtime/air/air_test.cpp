// Air and fields on the CPU: what curl noise promises, Stokes drag, and every wrong setting.
#include "runtime/air/air.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <vector>

#include "runtime/particles/emitter.h"
#include "tests/runtime/air/air_reference.h"

namespace relief {
namespace {

glm::vec3 randomPoint(Pcg32& random, float reach) {
    const float x = random.between(-reach, reach);
    const float y = random.between(-reach, reach);
    return {x, y, random.between(-reach, reach)};
}

constexpr double kUnitRms = 1.45944383;  // as curl_noise.cpp says

/// One octave at rest, of amplitude 1, whose lattice has the object's unit.
CurlNoise unitLattice(std::uint32_t seed) {
    return {1.0F, curlUnits({.scale = 1.0F}), 1, 0.0F, seed};
}

/// Where the point of skewed coordinates q lies.
glm::vec3 unskewed(const glm::dvec3& q) {
    return glm::vec3(q - (q.x + q.y + q.z) / 6.0);
}

glm::vec3 randomDirection(Pcg32& random) {
    glm::vec3 d;
    do {
        d = randomPoint(random, 1.0F);
    } while (glm::dot(d, d) > 1.0F || glm::dot(d, d) < 0.01F);
    return glm::normalize(d);
}

/// No speed exceeds so many amplitudes: the header says so.
double speedMax() {
    return 4.4 * std::sqrt(2.0) * 15.0 / std::sqrt(85.0);
}

/// The two vectors of a lattice point: near it the velocity is t² ((4t/3 - 1/2) b + (b·d) d + a × d) with
/// t = 1/2 - |d|². So at it the velocity is b / 24; and its curl is a / 2, of which central differences over h
/// miss 4 h².
std::array<double, 6> cornerNumbers(const CurlNoise& noise, const glm::ivec3& point, float t = 0.0F) {
    constexpr float kStep = 0.02F;
    const glm::vec3 p = unskewed(point);
    const glm::dvec3 b = glm::dvec3(curlVelocity(noise, p, t)) * (24.0 / kUnitRms);
    glm::dvec3 d[3];
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 e(0.0F);
        e[axis] = kStep;
        d[axis] = glm::dvec3(curlVelocity(noise, p + e, t) - curlVelocity(noise, p - e, t));
    }
    const glm::dvec3 a = glm::dvec3(d[1].z - d[2].y, d[2].x - d[0].z, d[0].y - d[1].x) /
                         (static_cast<double>(kStep) * kUnitRms);
    return {a.x, a.y, a.z, b.x, b.y, b.z};
}

// Central differences over 0.02 of the finest cell are off by h²/6 of a third derivative, some 1e-3 of the
// gradient, and by roundings of some 1e-4 of it. A field with divergence, or with one term of the curl wrong,
// has as much of it as of anything else.
TEST(CurlNoise, HasNoDivergence) {
    for (const int octaves : {1, 2, 4}) {
        const CurlNoise noise{1.5F, 0.8F, octaves, 0.4F, 7};
        const float h = 0.02F * noise.scale / static_cast<float>(1 << (octaves - 1));
        Pcg32 random(1);
        double divergence = 0.0;
        double gradient = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 p = randomPoint(random, 4.0F);
            const float t = random.between(0.0F, 20.0F);
            double sum = 0.0;
            for (int axis = 0; axis < 3; ++axis) {
                glm::vec3 e(0.0F);
                e[axis] = h;
                const glm::dvec3 d =
                    (glm::dvec3(curlVelocity(noise, p + e, t)) - glm::dvec3(curlVelocity(noise, p - e, t))) /
                    (2.0 * static_cast<double>(h));
                sum += d[axis];
                gradient += glm::dot(d, d);
            }
            divergence += sum * sum;
        }
        EXPECT_LT(std::sqrt(divergence / gradient), 2e-3) << octaves;
        EXPECT_GT(gradient, 1.0);
    }
}

// The amplitude is the root mean square of the speed, whatever the octaves, the seed and the time, and no
// direction is preferred.
TEST(CurlNoise, HasTheAmplitudeItSaysAndNoPreferredDirection) {
    for (const int octaves : {1, 2, 3, 4}) {
        for (const float t : {0.0F, 0.75F}) {  // a pattern, and half way to the next
            const CurlNoise noise{2.0F, 0.5F, octaves, 1.0F / 3.0F, static_cast<std::uint32_t>(octaves)};
            Pcg32 random(2);
            glm::dvec3 mean(0.0);
            glm::dvec3 squares(0.0);
            double fastest = 0.0;
            constexpr int kPoints = 60'000;
            for (int i = 0; i < kPoints; ++i) {
                const glm::dvec3 v(curlVelocity(noise, randomPoint(random, 100.0F), t));
                mean += v / static_cast<double>(kPoints);
                squares += v * v / static_cast<double>(kPoints);
                fastest = std::max(fastest, glm::length(v));
            }
            EXPECT_NEAR(std::sqrt(squares.x + squares.y + squares.z), 2.0, 0.02) << octaves << " " << t;
            EXPECT_LT(fastest, 4.0 * 2.0) << "the header says so";
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_NEAR(mean[axis], 0.0, 0.025) << octaves << " " << t;
                EXPECT_NEAR(squares[axis], 4.0 / 3.0, 0.05) << octaves << " " << t;
            }
        }
    }
}

TEST(CurlNoise, IsTheSameForTheSameSeedAndAnotherForAnother) {
    CurlNoise noise{1.0F, 1.0F, 3, 0.5F, 42};
    const CurlNoise same = noise;
    CurlNoise other = noise;
    other.seed = 43;
    Pcg32 random(3);
    double product = 0.0;
    double square = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p = randomPoint(random, 50.0F);
        const glm::vec3 v = curlVelocity(noise, p, 3.0F);
        ASSERT_EQ(v, curlVelocity(same, p, 3.0F));
        product += static_cast<double>(glm::dot(v, curlVelocity(other, p, 3.0F)));
        square += static_cast<double>(glm::dot(v, v));
    }
    EXPECT_NEAR(product / square, 0.0, 0.05);
}

// Pinned: the noise of a seed is part of a scene's result.
TEST(CurlNoise, LatticePointsHaveOddNumbersOfTheSeed) {
    Pcg32 random(6);
    for (const std::uint32_t seed : {1U, 2U, 4'000'000'000U}) {
        for (int i = 0; i < 200; ++i) {
            const glm::ivec3 point(randomPoint(random, 40.0F));
            for (const double number : cornerNumbers(unitLattice(seed), point)) {
                const double odd = 2.0 * std::floor(0.5 * number) + 1.0;
                ASSERT_NEAR(number, odd, 0.06) << seed;
                ASSERT_LE(std::abs(odd), 15.0) << seed;
            }
        }
    }
    constexpr double kNumbers[2][6] = {{7, 3, -3, -5, -11, -1}, {1, -9, 9, 5, 13, -1}};
    const glm::ivec3 points[2] = {glm::ivec3(0), glm::ivec3(3, -2, 5)};
    for (std::size_t i = 0; i < 2; ++i) {
        const std::array<double, 6> numbers = cornerNumbers(unitLattice(1), points[i]);
        for (std::size_t m = 0; m < 6; ++m) {
            EXPECT_NEAR(numbers[m], kNumbers[i][m], m < 3 ? 0.06 : 1e-3) << i << " " << m;
        }
    }
}

constexpr int kCubeSide = 64;
constexpr int kCube = kCubeSide * kCubeSide * kCubeSide;
using Numbers = std::vector<std::array<float, 6>>;

/// The numbers of a cube of lattice points, x fastest.
Numbers cubeOfNumbers(const CurlNoise& noise, const glm::ivec3& origin, float t) {
    Numbers all;
    for (int i = 0; i < kCube; ++i) {
        const glm::ivec3 offset(i % kCubeSide, i / kCubeSide % kCubeSide, i / (kCubeSide * kCubeSide));
        const std::array<double, 6> at = cornerNumbers(noise, origin + offset, t);
        std::array<float, 6>& odd = all.emplace_back();
        std::transform(at.begin(), at.end(), odd.begin(),
                       [](double x) { return static_cast<float>(2.0 * std::floor(0.5 * x) + 1.0); });
    }
    return all;
}

/// Of the correlations of a number of `a` with one of `b`, which lies by `offset` from it, the largest: in units of
/// what they are by luck.
double worstCorrelation(const Numbers& a, const Numbers& b, const glm::ivec3& offset) {
    const auto wrapped = [](int at, int by) { return (at + by + kCubeSide) % kCubeSide; };
    double sums[6][6] = {};
    for (int i = 0; i < kCube; ++i) {
        const int y = wrapped(i / kCubeSide % kCubeSide, offset.y);
        const int z = wrapped(i / (kCubeSide * kCubeSide), offset.z);
        const int j = wrapped(i % kCubeSide, offset.x) + kCubeSide * (y + kCubeSide * z);
        for (std::size_t m = 0; m < 6; ++m) {
            for (std::size_t n = 0; n < 6; ++n) {
                sums[m][n] += static_cast<double>(a[static_cast<std::size_t>(i)][m] *
                                                  b[static_cast<std::size_t>(j)][n]);
            }
        }
    }
    double worst = 0.0;
    for (std::size_t m = 0; m < 6; ++m) {
        for (std::size_t n = 0; n < 6; ++n) {
            const bool itself = &a == &b && offset == glm::ivec3(0) && m == n;
            worst = std::max(worst, std::abs(sums[m][n] / 85.0 - (itself ? kCube : 0.0)));
        }
    }
    return worst / std::sqrt(static_cast<double>(kCube));
}

/// Of the waves that a number of the cube consists of, the greatest power over the mean power.
double greatestWave(const Numbers& numbers, std::size_t which) {
    std::vector<std::complex<double>> turn(kCubeSide);
    for (std::size_t i = 0; i < kCubeSide; ++i) {
        turn[i] = std::polar(1.0, 2.0 * 3.14159265358979 * static_cast<double>(i) / kCubeSide);
    }
    std::vector<std::complex<double>> wave(kCube);
    std::transform(numbers.begin(), numbers.end(), wave.begin(),
                   [&](const std::array<float, 6>& one) { return static_cast<double>(one.at(which)); });
    // A fast Fourier transform, which leaves the waves in another order.
    for (const std::size_t stride : {1, kCubeSide, kCubeSide * kCubeSide}) {
        for (std::size_t half = kCubeSide / 2; half >= 1; half /= 2) {
            for (std::size_t i = 0; i < kCube; ++i) {
                const std::size_t at = i / stride % kCubeSide;
                if ((at & half) == 0) {
                    const std::complex<double> other = wave[i + half * stride];
                    wave[i + half * stride] = (wave[i] - other) * turn[at % half * (kCubeSide / 2 / half)];
                    wave[i] += other;
                }
            }
        }
    }
    double greatest = 0.0;
    for (const std::complex<double>& one : wave) {
        greatest = std::max(greatest, std::norm(one) / (85.0 * kCube));
    }
    return greatest;
}

// Between lattice points that are neighbours, between the six numbers of one, between patterns and between seeds
// there is no correlation; each number is as frequent as the others; and no wave stands out, as it would if a
// number hung on few of the point's bits.
TEST(CurlNoise, DrawsIndependentNumbers) {
    const glm::ivec3 origin(-kCubeSide / 2);
    CurlNoise noise = unitLattice(9);
    noise.drift = noise.scale;  // a pattern a second
    const Numbers numbers = cubeOfNumbers(noise, origin, 0.0F);
    constexpr double kLuck = 5.5;   // of six hundred pairs
    for (int i = 0; i < 14; ++i) {  // the others are these the other way about
        const glm::ivec3 offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
        EXPECT_LT(worstCorrelation(numbers, numbers, offset), kLuck) << i;
    }
    const glm::ivec3 here(0);
    EXPECT_LT(worstCorrelation(numbers, cubeOfNumbers(noise, origin, 1.0F), here), kLuck);
    EXPECT_LT(worstCorrelation(numbers, cubeOfNumbers(unitLattice(10), origin, 0.0F), here), kLuck);
    EXPECT_LT(worstCorrelation(numbers, cubeOfNumbers(noise, origin + kCubeSide, 0.0F), here), kLuck);
    for (std::size_t m = 0; m < 6; ++m) {
        std::array<int, 16> frequency{};
        for (const std::array<float, 6>& one : numbers) {
            ++frequency.at(static_cast<std::size_t>(one.at(m) + 15.0F) / 2);
        }
        for (const int count : frequency) {
            EXPECT_NEAR(count, kCube / 16.0, 5.0 * std::sqrt(kCube / 16.0)) << m;
        }
        // More than x has chance exp(-x) for each of 2^17 waves.
        EXPECT_LT(greatestWave(numbers, m), 20.0) << m;
    }
}

// Where the simplices meet, other corners have a share in the velocity: at faces within a cell's cube, where two
// fractions are equal, and at those between cubes. A wrong order of corners, or a share that does not end at the
// face opposite to its corner, makes the velocity jump; a share that ends too abruptly makes it bend.
TEST(CurlNoise, HasNoJumpAndNoKinkAtTheFacesOfSimplices) {
    const CurlNoise noise = unitLattice(3);
    Pcg32 random(8);
    constexpr int kFaces = 7;  // of the last kind: anywhere
    std::array<double, kFaces> bend{};
    constexpr int kPoints = 4000;
    for (int face = 0; face < kFaces; ++face) {
        for (int i = 0; i < kPoints; ++i) {
            glm::dvec3 q(randomPoint(random, 20.0F));
            if (face < 3) {
                const int next = (face + 1) % 3;
                q[next] = std::floor(q[next]) + q[face] - std::floor(q[face]);
            } else if (face < 6) {
                q[face - 3] = std::round(q[face - 3]);
            }
            const glm::vec3 p = unskewed(q);
            const glm::vec3 n = randomDirection(random);
            // No derivative exceeds 30 or so.
            const glm::vec3 jump =
                curlVelocity(noise, p + 1e-4F * n, 0.0F) - curlVelocity(noise, p - 1e-4F * n, 0.0F);
            ASSERT_LT(glm::length(jump), 0.01F) << face;
            const glm::vec3 second = curlVelocity(noise, p + 0.01F * n, 0.0F) -
                                     2.0F * curlVelocity(noise, p, 0.0F) +
                                     curlVelocity(noise, p - 0.01F * n, 0.0F);
            bend[static_cast<std::size_t>(face)] += static_cast<double>(glm::dot(second, second)) / kPoints;
        }
    }
    // A kink would be some 0.01 times a derivative, of which the root mean square is 7.
    for (int face = 0; face < kFaces; ++face) {
        EXPECT_LT(std::sqrt(bend[static_cast<std::size_t>(face)]), 0.01) << face;
    }
}

// The size of eddies is that of the cubic lattice's gradient noise: the mean square of all nine derivatives over
// that of the velocity is 29.1052974 / scale², by integrals of polynomials in closed form.
TEST(CurlNoise, HasEddiesOfItsScale) {
    for (const float scale : {0.3F, 2.0F}) {
        const CurlNoise noise{1.5F, scale, 1, 0.2F, 11};
        const float h = 0.01F * scale;
        Pcg32 random(9);
        double velocity = 0.0;
        double derivative = 0.0;
        for (int i = 0; i < 60'000; ++i) {
            const glm::vec3 p = randomPoint(random, 50.0F * scale);
            const glm::dvec3 v(curlVelocity(noise, p, 0.7F));
            velocity += glm::dot(v, v);
            for (int axis = 0; axis < 3; ++axis) {
                glm::vec3 e(0.0F);
                e[axis] = h;
                const glm::dvec3 d =
                    glm::dvec3(curlVelocity(noise, p + e, 0.7F) - curlVelocity(noise, p - e, 0.7F)) /
                    (2.0 * static_cast<double>(h));
                derivative += glm::dot(d, d);
            }
        }
        const double square = static_cast<double>(scale) * static_cast<double>(scale);
        EXPECT_NEAR(derivative / velocity * square, 29.105, 0.4) << scale;
    }
}

// With all numbers at ±15, blended with another pattern of the same, a corner's share is at most √2 · 15 √3 ·
// t² (|driving| + |turning|), in whatever direction. Its greatest sum over the four corners is what the header says.
TEST(CurlNoise, BoundOfTheHeaderIsTheWorstSumOfShares) {
    constexpr int kParts = 48;
    double worst = 0.0;
    for (int i = 0; i < kParts * kParts * kParts; ++i) {
        const glm::dvec3 f =
            glm::dvec3(i % kParts, i / kParts % kParts, i / (kParts * kParts)) / double{kParts};
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 q = f - glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2);
            const glm::dvec3 d = q - (q.x + q.y + q.z) / 6.0;
            const double t = std::max(0.5 - glm::dot(d, d), 0.0);  // 0 at the four others
            sum += t * t * (std::max(t / 3.0, std::abs(4.0 * t / 3.0 - 0.5)) + glm::length(d));
        }
        worst = std::max(worst, sum);
    }
    worst *= 15.0 * std::sqrt(3.0) * kUnitRms;
    EXPECT_NEAR(worst, 4.314, 0.002);
    EXPECT_LT(worst, 4.4);
}

TEST(CurlNoise, ChangesSmoothlyInTimeAndRepeatsAfterItsPeriod) {
    const CurlNoise noise{1.0F, 0.5F, 3, 0.25F, 5};  // a pattern lasts 2 s
    Pcg32 random(4);
    double correlation = 0.0;
    for (int i = 0; i < 300; ++i) {
        const glm::vec3 p = randomPoint(random, 10.0F);
        for (const float t : {0.5F, 1.0F, 2.0F, 6.0F}) {  // where patterns of some octave follow each other
            const glm::vec3 step = curlVelocity(noise, p, t + 1e-3F) - curlVelocity(noise, p, t - 1e-3F);
            ASSERT_LT(glm::length(step), 0.05F);
        }
        correlation +=
            static_cast<double>(glm::dot(curlVelocity(noise, p, 0.0F), curlVelocity(noise, p, 2.0F)));
        ASSERT_EQ(curlTime(noise, 256.0 + 0.5), 0.5F);
        ASSERT_LT(glm::length(curlVelocity(noise, p, 255.9999F) - curlVelocity(noise, p, 0.0F)), 0.01F)
            << "a jump where time is taken back";
    }
    EXPECT_NEAR(correlation / 300.0, 0.0, 0.15) << "after a pattern's time another should blow";
    CurlNoise still = noise;
    still.drift = 0.0F;
    EXPECT_EQ(curlTime(still, 1e6), 0.0F);
}

// Far away floats are coarser than cells: the velocity is then that of some other place, but no greater.
TEST(CurlNoise, AnswersAtExtremePoints) {
    const CurlNoise noise{1.0F, 1e-3F, 4, 1e-4F, 5};
    for (const float far : {1e6F, 1e30F, 3e38F, -3e38F, std::nanf("")}) {
        const glm::vec3 v = curlVelocity(noise, {0.0F, far, far}, 0.0F);
        EXPECT_TRUE(std::isfinite(glm::length(v))) << far;
    }
    Pcg32 random(12);
    const float infinity = std::numeric_limits<float>::infinity();
    for (int i = 0; i < 100'000; ++i) {
        // From 1 to 2^33 lattice units in each axis, some beyond all numbers.
        glm::vec3 p = randomPoint(random, 1.0F);
        for (int axis = 0; axis < 3; ++axis) {
            p[axis] = std::ldexp(p[axis], static_cast<int>(random.between(-10.0F, 24.0F)));
            p[axis] = random.between(0.0F, 1.0F) < 0.02F ? std::copysign(infinity, p[axis]) : p[axis];
        }
        const glm::vec3 v = curlVelocity(noise, p, random.between(0.0F, 100.0F));
        ASSERT_LT(static_cast<double>(glm::length(v)), speedMax()) << p.x << " " << p.y << " " << p.z;
    }
}

// A drop of 0.1 mm across in air: k = 9 viscosity / (2 density radius²).
TEST(Air, StokesRateOfADrop) {
    const double radius = 5e-5;
    const double mass = 1000.0 * 4.0 / 3.0 * 3.14159265358979 * radius * radius * radius;
    const double expected = 9.0 * 1.8e-5 / (2.0 * 1000.0 * radius * radius);
    EXPECT_NEAR(expected, 32.4, 1e-9);
    EXPECT_NEAR(
        static_cast<double>(stokesRate(1.8e-5F, static_cast<float>(radius), static_cast<float>(mass))),
        expected, 1e-5 * expected);
    EXPECT_EQ(stokesRate(0.0F, 1.0F, 1.0F), 0.0F);
}

TEST(Air, WrongSettingsAreNamed) {
    AirSettings good;
    good.attractors.resize(8);
    good.vortices.resize(8);
    good.curl_noise = CurlNoise{};
    good.flow = std::make_shared<FlowField>(FlowField{.nodes = {glm::vec3(1.0F)}});
    ASSERT_TRUE(checkAir(good)) << checkAir(good).error().message;
    struct Case {
        const char* part;
        ErrorCode code;
        std::function<void(AirSettings&)> spoil;
    };
    const float nan = std::nanf("");
    const auto flowOf = [](FlowField flow) { return std::make_shared<FlowField>(std::move(flow)); };
    const Case cases[] = {
        {"wind", ErrorCode::kUsage, [&](AirSettings& a) { a.wind.y = nan; }},
        {"viscosity", ErrorCode::kUsage, [](AirSettings& a) { a.viscosity = -1.0F; }},
        {"9 attractors", ErrorCode::kUsage, [](AirSettings& a) { a.attractors.resize(9); }},
        {"9 vortices", ErrorCode::kUsage, [](AirSettings& a) { a.vortices.resize(9); }},
        {"attractor 2", ErrorCode::kUsage, [](AirSettings& a) { a.attractors[2].radius = 0.0F; }},
        {"attractor 3", ErrorCode::kUsage, [](AirSettings& a) { a.attractors[3].falloff = 3; }},
        {"attractor 4", ErrorCode::kUsage, [&](AirSettings& a) { a.attractors[4].strength = nan; }},
        {"vortex 1", ErrorCode::kUsage, [](AirSettings& a) { a.vortices[1].axis = glm::vec3(0.0F); }},
        {"vortex 7", ErrorCode::kUsage, [](AirSettings& a) { a.vortices[7].falloff = -1; }},
        {"octaves", ErrorCode::kUsage, [](AirSettings& a) { a.curl_noise->octaves = 5; }},
        {"scale", ErrorCode::kUsage, [](AirSettings& a) { a.curl_noise->scale = 0.0F; }},
        {"drift", ErrorCode::kUsage, [](AirSettings& a) { a.curl_noise->drift = 1001.0F; }},
        {"3 velocities", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             a.flow = flowOf({.size = {2, 2, 1}, .nodes = std::vector<glm::vec3>(3)});
         }},
        {"empty", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             a.flow = flowOf({.size = {2, 0, 1}, .nodes = {}});
         }},
        {"empty on the y axis", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             a.flow = flowOf({.box_max = {1.0F, 0.0F, 1.0F}, .nodes = {glm::vec3(0.0F)}});
         }},
        {"at node 1, 0, 1 is not finite", ErrorCode::kInvalidInput,
         [&](AirSettings& a) {
             FlowField flow{.size = {2, 1, 2}, .nodes = std::vector<glm::vec3>(4, glm::vec3(0.0F))};
             flow.nodes[3].z = nan;
             a.flow = flowOf(std::move(flow));
         }},
        {"bytes", ErrorCode::kLimit,
         [&](AirSettings& a) {
             a.flow = flowOf({.size = {512, 512, 65}, .nodes = {}});
         }},
    };
    for (const Case& one : cases) {
        AirSettings air = good;
        one.spoil(air);
        const auto checked = checkAir(air);
        ASSERT_FALSE(checked) << one.part;
        EXPECT_EQ(checked.error().code, one.code) << one.part;
        EXPECT_NE(checked.error().message.find(one.part), std::string::npos) << checked.error().message;
    }
}

}  // namespace
}  // namespace relief
