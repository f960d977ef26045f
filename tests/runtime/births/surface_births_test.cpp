// SPDX-License-Identifier: Apache-2.0
// Births on moving and deforming surfaces, against closed forms for fixed seeds; and the surface extracted from a
// collider's field: near closed forms, closed, oriented outwards.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <numbers>

#include "runtime/births/collider_surface.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/births/emitter_surface.h"
#include "runtime/particles/emitter.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/results.h"
#include "tests/runtime/collider/analytic_collider.h"
#include "tests/runtime/particles/statistics.h"

namespace relief::test {
namespace {

constexpr int kPlaces = 50'000;
constexpr double kPi = std::numbers::pi;

/// A grid of `u` × `v` quads, whose vertex (i, j) is at place(i / u, j / v).
struct Grid {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;

    Grid(std::uint32_t u, std::uint32_t v, const std::function<glm::dvec3(double, double)>& place) {
        for (std::uint32_t i = 0; i <= u; ++i) {
            for (std::uint32_t j = 0; j <= v; ++j) {
                positions.emplace_back(place(double(i) / u, double(j) / v));
                if (i < u && j < v) {
                    const std::uint32_t k = i * (v + 1) + j;
                    triangles.emplace_back(k, k + v + 1, k + v + 2);
                    triangles.emplace_back(k, k + v + 2, k + 1);
                }
            }
        }
    }
};

EmitterSurface surfaceOf(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions,
                         std::vector<float> weights = {}) {
    return required(EmitterSurface::create(triangles, std::move(weights), positions));
}

std::vector<EmitterSurface::Place> drawn(const EmitterSurface& surface, int count = kPlaces,
                                         float age = 0.0F) {
    Pcg32 random(7);
    std::vector<EmitterSurface::Place> places;
    for (int i = 0; i < count; ++i) {
        places.push_back(surface.draw(random, age));
    }
    return places;
}

TEST(EmitterSurface, LiesOnTheFacesOfABoxAndPointsOutwards) {
    const glm::vec3 half(0.5F, 2.0F, 0.1F);
    const AnimatedMesh box = movingBox(half);
    std::vector<std::size_t> counts(3);
    for (const EmitterSurface::Place& place : drawn(surfaceOf(box.triangles, box.positions))) {
        ASSERT_NEAR(glm::length(place.normal), 1.0F, 1e-6F);
        ASSERT_EQ(place.velocity, glm::vec3(0.0F));
        int axis = 0;
        while (axis < 2 && std::abs(place.normal[axis]) < 0.5F) {
            ++axis;
        }
        ASSERT_NEAR(place.position[axis], std::copysign(half[axis], place.normal[axis]), 1e-6F);
        ++counts[static_cast<std::size_t>(axis)];
    }
    EXPECT_LT(test::chiSquare(counts, {2.0 * 0.1, 0.5 * 0.1, 0.5 * 2.0}), test::kChiSquareMax);
}

// A straight pipe bent into a quarter of a torus: its outer side is stretched by R + r cos φ.
TEST(EmitterSurface, IsUniformOnABentPipe) {
    constexpr double kBend = 1.0;
    constexpr double kRadius = 0.5;
    const auto straight = [](double u, double v) {
        return glm::dvec3(kBend + kRadius * std::cos(2 * kPi * v), 0.5 * kPi * kBend * u,
                          kRadius * std::sin(2 * kPi * v));
    };
    const auto bent = [](double u, double v) {
        const double out = kBend + kRadius * std::cos(2 * kPi * v);
        return glm::dvec3(out * std::cos(0.5 * kPi * u), out * std::sin(0.5 * kPi * u),
                          kRadius * std::sin(2 * kPi * v));
    };
    const Grid rest(200, 400, straight);
    const Grid turned(200, 400, bent);
    EmitterSurface surface = surfaceOf(rest.triangles, rest.positions);
    surface.move(rest.positions, turned.positions, 0.0);
    EXPECT_NEAR(surface.area(), 0.5 * kPi * kBend * 2 * kPi * kRadius, 1e-3);
    std::vector<double> around;
    std::vector<double> along;
    for (const EmitterSurface::Place& place : drawn(surface, 100'000)) {
        const glm::dvec3 p(place.position);
        const double phi = std::atan2(p.z, std::hypot(p.x, p.y) - kBend);
        around.push_back(phi < 0.0 ? phi + 2 * kPi : phi);
        along.push_back(std::atan2(p.y, p.x));
    }
    EXPECT_LT(test::kolmogorov(along, [](double theta) { return theta / (0.5 * kPi); }),
              test::kKolmogorovMax);
    const auto bent_fraction = [](double phi) {
        return (kBend * phi + kRadius * std::sin(phi)) / (2 * kPi * kBend);
    };
    EXPECT_LT(test::kolmogorov(around, bent_fraction), test::kKolmogorovMax);
    EXPECT_GT(test::kolmogorov(around, [](double phi) { return phi / (2 * kPi); }), 20.0)
        << "areas at rest would be detected";
}

// Points of a rotating body move with ω × r. The error of the linear path stays within the header's bounds.
TEST(EmitterSurface, MovesLikeARotatingBody) {
    const AnimatedMesh box = movingBox({0.5F, 0.3F, 0.2F});
    const glm::vec3 axis = glm::normalize(glm::vec3(1.0F, 2.0F, -1.0F));
    constexpr double kTurn = 3.0;  // radians per second
    EmitterSurface surface = surfaceOf(box.triangles, box.positions);
    for (const double dt : {1.0 / 30, 1.0 / 60, 1.0 / 240}) {
        const auto turned = [&](double time) {
            std::vector<glm::vec3> out;
            const glm::mat3 turn = glm::mat3_cast(glm::angleAxis(static_cast<float>(kTurn * time), axis));
            for (const glm::vec3& p : box.positions) {
                out.push_back(turn * p);
            }
            return out;
        };
        surface.move(turned(0.4 - dt), turned(0.4), dt);
        const float age = static_cast<float>(0.5 * dt);
        const std::vector<EmitterSurface::Place> then = drawn(surface, 500, age);
        surface.move(turned(0.4), turned(0.4 - 0.5 * dt), 0.0);
        const std::vector<EmitterSurface::Place> exact = drawn(surface, 500);
        for (std::size_t i = 0; i < then.size(); ++i) {
            const glm::vec3 velocity = float(kTurn) * glm::cross(axis, exact[i].position);
            const double arm = double{glm::length(velocity)} / kTurn;
            ASSERT_LE(double{glm::length(then[i].position - exact[i].position)},
                      arm * kTurn * kTurn * dt * dt / 8 + 1e-6);
            ASSERT_LE(double{glm::length(then[i].velocity - velocity)},
                      arm * kTurn * kTurn * dt / 2 * 1e-1 + 1e-6 / dt)
                << "the error is far smaller in the middle of the step";
            ASSERT_GT(glm::dot(then[i].normal, exact[i].normal), 0.99999F);
        }
    }
}

TEST(EmitterSurface, WeightsAreALinearDensity) {
    const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    const std::vector<glm::uvec3> two{{0, 1, 2}, {3, 4, 5}};
    // If only one corner has a weight, its barycentric coordinate has a beta distribution, 6 x (1 − x).
    for (std::size_t corner = 0; corner < 3; ++corner) {
        std::vector<float> weights(6, 0.0F);
        weights[corner] = 0.3F;
        std::vector<double> coordinates;
        for (const EmitterSurface::Place& place : drawn(surfaceOf(two, corners, weights))) {
            const double x{place.position.x};
            const double y{place.position.y};
            ASSERT_LE(x + y, 1.000001) << "the other triangle has no weight";
            coordinates.push_back(corner == 0 ? 1.0 - x - y : corner == 1 ? x : y);
        }
        EXPECT_LT(test::kolmogorov(coordinates, [](double x) { return x * x * (3.0 - 2.0 * x); }),
                  test::kKolmogorovMax);
    }
    // A triangle with three times the mean weight has three times the births.
    std::size_t near = 0;
    for (const EmitterSurface::Place& place :
         drawn(surfaceOf(two, corners, {1.0F, 0.5F, 0.3F, 0.1F, 0.2F, 0.3F}))) {
        near += place.position.x < 2.0F ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(near) / kPlaces, 0.75, 5 * std::sqrt(0.1875 / kPlaces));
}

TEST(EmitterSurface, RejectsInvalidSurfaces) {
    const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<glm::uvec3> one{{0, 1, 2}};
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto refused = [](const std::vector<glm::uvec3>& triangles, const std::vector<float>& weights,
                            const std::vector<glm::vec3>& positions) {
        return !EmitterSurface::create(triangles, weights, positions);
    };
    EXPECT_TRUE(refused({{0, 1, 3}}, {}, corners));
    EXPECT_TRUE(refused({{0, 1, 1}}, {}, corners));
    EXPECT_TRUE(refused({}, {}, corners));
    EXPECT_TRUE(refused(one, {1.0F}, corners));
    EXPECT_TRUE(refused(one, {1.0F, -1.0F, 1.0F}, corners));
    EXPECT_TRUE(refused(one, {1.0F, kNan, 1.0F}, corners));
    EXPECT_TRUE(refused(one, {0.0F, 0.0F, 0.0F}, corners));
    EXPECT_TRUE(refused(one, {}, {{0, 0, 0}, {1, 0, 0}, {kNan, 1, 0}}));
    EXPECT_TRUE(refused(one, {}, {{0, 0, 0}, {1, 0, 0}, {kInfinity, 1, 0}}));
    // Tiny and huge surfaces work as well.
    for (const float scale : {1e-18F, 1e15F}) {
        EmitterSurface surface = surfaceOf(one, {corners[0], scale * corners[1], scale * corners[2]});
        Pcg32 random(1);
        const EmitterSurface::Place place = surface.draw(random, 0.0F);
        EXPECT_EQ(place.normal, glm::vec3(0, 0, 1));
        EXPECT_GT(place.position.x, 0.0F);
    }
}

EmitterSettings settingsOf(EmitterSurface surface) {
    EmitterSettings settings;
    settings.shape = EmitterShape::kSurface;
    settings.surface = BirthSurfaceValue(surface.clone());
    settings.rate = 3000.0;
    EmitterAim& aim = settings.aim.emplace();
    aim.speed_min = 2.0F;
    aim.speed_max = 2.0F;
    return settings;
}

TEST(EmitterSurface, EmittersThrowAlongTheNormalAndAddTheSurfaceVelocity) {
    const AnimatedMesh box = movingBox({0.5F, 0.3F, 0.2F});
    Emitter emitter(settingsOf(surfaceOf(box.triangles, box.positions)), 1);
    std::vector<glm::vec3> later = box.positions;
    for (glm::vec3& p : later) {
        p += glm::vec3(0.1F, 0.0F, 0.2F);
    }
    emitter.moveSurface(box.positions, later, 0.1);
    std::vector<Birth> births;
    EXPECT_TRUE(emitter.isDue(0.1));
    EXPECT_EQ(emitter.emit(0.1, 1000, births), 0U);
    ASSERT_EQ(births.size(), 300U);
    ASSERT_EQ(emitter.birthSurfaceVelocities().size(), births.size());
    EmitterMotion motion;
    // Scaled and rotated like its body, whose own velocity is added.
    const glm::quat quarter = glm::angleAxis(float(kPi) / 2, glm::vec3(0, 1, 0));
    motion.body = {{0.0, {{0, 0, 0}, quarter, 3.0F}}, {1.0, {{0, 5, 0}, quarter, 3.0F}}};
    motion.inherit = 0.5F;
    const std::vector<Birth> own = births;
    carry(motion, 0.5, births, emitter.birthSurfaceVelocities());
    for (std::size_t i = 0; i < births.size(); ++i) {
        EXPECT_NEAR(glm::length(own[i].velocity), 2.0F, 1e-5F);
        const glm::vec3 at_end = own[i].position + own[i].age * glm::vec3(1, 0, 2);
        const glm::vec3 from = glm::abs(at_end - glm::vec3(0.1F, 0, 0.2F)) - glm::vec3(0.5F, 0.3F, 0.2F);
        EXPECT_NEAR(std::max({from.x, from.y, from.z}), 0.0F, 1e-5F) << "on the box at the time of birth";
        // x maps to −z, and z to x.
        const glm::vec3 thrown = births[i].velocity - quarter * own[i].velocity;
        EXPECT_LT(glm::length(thrown - 0.5F * glm::vec3(3 * 2.0F, 5.0F, -3 * 1.0F)), 1e-4F);
    }
}

TEST(EmitterSurface, NoAreaMeansNoBirths) {
    const AnimatedMesh box = movingBox({0.5F, 0.3F, 0.2F});
    EmitterSettings settings = settingsOf({});
    EXPECT_FALSE(Emitter::check(settings));
    settings.surface = BirthSurfaceValue(surfaceOf(box.triangles, box.positions).clone());
    ASSERT_TRUE(Emitter::check(settings));
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    // Degenerate to a line, then to non-finite numbers: births that are due are refused, later ones are born.
    for (const float all : {1.0F, std::numeric_limits<float>::infinity()}) {
        emitter.moveSurface(box.positions, std::vector<glm::vec3>(8, glm::vec3(all)), 0.1);
        EXPECT_EQ(emitter.emit(0.1, 1000, births), 300U);
    }
    EXPECT_TRUE(births.empty());
    emitter.moveSurface(std::vector<glm::vec3>(8, glm::vec3(std::numeric_limits<float>::quiet_NaN())),
                        box.positions, 0.1);
    EXPECT_EQ(emitter.emit(0.1, 1000, births), 0U);
    ASSERT_EQ(births.size(), 300U);
    for (const Birth& birth : births) {
        EXPECT_TRUE(isValid(birth));
    }
}

ColliderSurface surfaceOf(const Collider& collider, std::uint32_t cells = kSurfaceCells) {
    auto made = colliderSurface(collider, cells);
    EXPECT_TRUE(made) << made.error().message;
    return made ? std::move(*made) : ColliderSurface{};
}

double areaOf(const ColliderSurface& surface) {
    double area = 0.0;
    for (const glm::uvec3& t : surface.triangles) {
        const glm::dvec3 p(surface.positions[t.x]);
        area += 0.5 * glm::length(glm::cross(glm::dvec3(surface.positions[t.y]) - p,
                                             glm::dvec3(surface.positions[t.z]) - p));
    }
    return area;
}

double volumeOf(const ColliderSurface& surface) {
    double volume = 0.0;
    for (const glm::uvec3& t : surface.triangles) {
        volume +=
            glm::dot(glm::dvec3(surface.positions[t.x]),
                     glm::cross(glm::dvec3(surface.positions[t.y]), glm::dvec3(surface.positions[t.z]))) /
            6.0;
    }
    return volume;
}

/// Every edge of a triangle is the reversed edge of another triangle.
bool isClosed(const ColliderSurface& surface) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (const glm::uvec3& t : surface.triangles) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k];
            const std::uint32_t b = t[(k + 1) % 3];
            sides[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    }
    return std::all_of(sides.begin(), sides.end(), [](const auto& side) { return side.second == 0; });
}

TEST(ColliderSurface, MatchesABall) {
    const ColliderSurface surface =
        surfaceOf(analytic::frontBackCollider(analytic::sphere({1, 2, 3}, 0.5), 256));
    EXPECT_TRUE(isClosed(surface));
    // Texels are planes, 1/256 of the side wide. They deviate from the ball by up to a thousandth at steep angles.
    for (const glm::vec3& p : surface.positions) {
        ASSERT_NEAR(glm::length(glm::dvec3(p) - glm::dvec3(1, 2, 3)), 0.5, 3e-3);
    }
    EXPECT_NEAR(areaOf(surface) / kPi, 1.0, 5e-3);
    ColliderSurface centred = surface;
    for (glm::vec3& p : centred.positions) {
        p -= glm::vec3(1, 2, 3);
    }
    EXPECT_NEAR(volumeOf(centred), kPi / 6, 2e-3) << "oriented outwards";
}

TEST(ColliderSurface, KeepsTheEdgesOfABox) {
    const glm::dvec3 half(0.5, 0.31, 0.17);
    const ColliderSurface surface = surfaceOf(analytic::frontBackCollider(analytic::box(-half, half), 256));
    EXPECT_TRUE(isClosed(surface));
    const double area = 8 * (half.x * half.y + half.y * half.z + half.z * half.x);
    // A texel at the rim, 1/254 of a side, may be full or empty.
    EXPECT_NEAR(areaOf(surface) / area, 1.0, 8e-3);
    EXPECT_NEAR(volumeOf(surface) / (8 * half.x * half.y * half.z), 1.0, 3e-2);
    for (const glm::vec3& p : surface.positions) {
        const glm::dvec3 from = glm::abs(glm::dvec3(p)) - half;
        ASSERT_NEAR(std::max({from.x, from.y, from.z}), 0.0, 4e-3);
    }
}

TEST(ColliderSurface, MaterialsHaveTheirFractionOfTheArea) {
    const glm::dvec3 half(0.5, 0.3, 0.2);
    Collider box = analytic::frontBackCollider(analytic::box(-half, half), 128);
    // The half with x > 0 is felt.
    box.materials.list = {{"oak"}, {"felt"}};
    box.materials.origin = glm::vec3(-1.0F);
    box.materials.size = 2.0F;
    box.materials.nodes = {{0, {0, 1, 0, 1, 0, 1, 0, 1}}};
    ASSERT_EQ(faultOfMaterials(box.materials), "");
    ColliderSurface felt = surfaceOf(box);
    const double all = areaOf(felt);
    felt.triangles = materialTriangles(felt, box.materials, "felt").value();
    // Grid cells on the border may belong to either side.
    EXPECT_NEAR(areaOf(felt), 0.5 * all, 4.0 * (half.y + half.z) / kSurfaceCells);
    EXPECT_TRUE(std::all_of(felt.triangles.begin(), felt.triangles.end(), [&](const glm::uvec3& t) {
        return felt.positions[t.x].x > -1.1F / kSurfaceCells;
    }));
    ColliderSurface oak = surfaceOf(box);
    oak.triangles = materialTriangles(oak, box.materials, "oak").value();
    EXPECT_NEAR(areaOf(oak) + areaOf(felt), all, 1e-9);
    const auto none = materialTriangles(oak, box.materials, "ice");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("'ice'"), std::string::npos) << none.error().message;
}

TEST(ColliderSurface, RejectsCollidersWithoutASurface) {
    const Collider ball = analytic::frontBackCollider(analytic::sphere({0, 0, 0}, 0.5), 32);
    EXPECT_FALSE(colliderSurface(ball, 1));
    EXPECT_FALSE(colliderSurface(ball, kSurfaceCellsMax + 1));
    EXPECT_TRUE(colliderSurface(ball, 2));
    Collider empty = ball;
    empty.bounds = {};
    EXPECT_FALSE(colliderSurface(empty));
    empty.bounds = {glm::vec3(0.0F), glm::vec3(std::numeric_limits<float>::infinity())};
    EXPECT_FALSE(colliderSurface(empty));
    // Bounds that do not touch the ball.
    empty.bounds = {glm::vec3(5.0F), glm::vec3(6.0F)};
    EXPECT_FALSE(colliderSurface(empty));
    // The ball lies between grid corners.
    empty.bounds = {glm::vec3(-10.1F), glm::vec3(1e6F)};
    EXPECT_FALSE(colliderSurface(empty));
}

}  // namespace
}  // namespace relief::test
