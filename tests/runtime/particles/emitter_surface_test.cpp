// Births on surfaces that move and bend: against closed forms, for fixed seeds.
#include "runtime/particles/emitter_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>

#include "formats/animation/mesh_parts.h"
#include "formats/animation/mesh_pose.h"
#include "runtime/particles/emitter.h"
#include "tests/formats/animation/animated_meshes.h"

namespace relief {
namespace {

constexpr int kCount = 100'000;
constexpr double kPi = std::numbers::pi;
/// Of Kolmogorov's distance times √n: above it by chance once in a million.
constexpr double kCritical = 2.7;

/// A grid of `u` times `v` quads, whose vertex (i, j) is at place(i / u, j / v).
struct Grid {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;

    Grid(int u, int v, const std::function<glm::dvec3(double, double)>& place) {
        for (int i = 0; i <= u; ++i) {
            for (int j = 0; j <= v; ++j) {
                positions.emplace_back(place(double(i) / u, double(j) / v));
            }
        }
        const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (v + 1) + j); };
        for (int i = 0; i < u; ++i) {
            for (int j = 0; j < v; ++j) {
                triangles.emplace_back(at(i, j), at(i + 1, j), at(i + 1, j + 1));
                triangles.emplace_back(at(i, j), at(i + 1, j + 1), at(i, j + 1));
            }
        }
    }
};

EmitterSurface surfaceOf(const std::vector<glm::uvec3>& triangles, const std::vector<glm::vec3>& positions,
                         std::vector<float> weights = {}) {
    auto made = EmitterSurface::create(triangles, std::move(weights), positions);
    EXPECT_TRUE(made) << made.error().message;
    return std::move(*made);
}

std::vector<EmitterSurface::Place> drawn(const EmitterSurface& surface, int count = kCount,
                                         float age = 0.0F) {
    Pcg32 random(7);
    std::vector<EmitterSurface::Place> places;
    for (int i = 0; i < count; ++i) {
        places.push_back(surface.draw(random, age));
    }
    return places;
}

/// Kolmogorov's distance of numbers from a distribution, times √n.
double off(std::vector<double> values, const std::function<double(double)>& cdf) {
    std::sort(values.begin(), values.end());
    const auto n = static_cast<double>(values.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double f = cdf(values[i]);
        worst = std::max({worst, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
    }
    return worst * std::sqrt(n);
}

/// Pearson's χ² of counts from their expected shares, less its mean, in its standard deviations; above 6 by chance
/// once in millions.
double chi(const std::vector<std::size_t>& counts, const std::vector<double>& areas) {
    double area = 0.0;
    double n = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        area += areas[i];
        n += static_cast<double>(counts[i]);
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        const double expected = n * areas[i] / area;
        sum += (static_cast<double>(counts[i]) - expected) * (static_cast<double>(counts[i]) - expected) /
               expected;
    }
    const double free = static_cast<double>(counts.size()) - 1.0;
    return (sum - free) / std::sqrt(2.0 * free);
}

// Archimedes: heights on a sphere are uniform. The grid is finest at its poles, so that births by vertex or by triangle would not be.
TEST(EmitterSurface, IsUniformOnASphere) {
    const Grid grid(160, 320, [](double u, double v) {
        return glm::dvec3(std::sin(kPi * u) * std::cos(2 * kPi * v), std::cos(kPi * u),
                          -std::sin(kPi * u) * std::sin(2 * kPi * v));
    });
    const EmitterSurface surface = surfaceOf(grid.triangles, grid.positions);
    EXPECT_NEAR(surface.area(), 4 * kPi, 2e-3);
    std::array<std::vector<double>, 3> heights;
    for (const EmitterSurface::Place& place : drawn(surface)) {
        ASSERT_NEAR(glm::length(place.position), 1.0F, 3e-4F);
        ASSERT_NEAR(glm::length(place.normal), 1.0F, 1e-6F);
        ASSERT_GT(std::abs(glm::dot(place.normal, place.position)), 0.999F);
        ASSERT_EQ(place.velocity, glm::vec3(0.0F));
        for (int axis = 0; axis < 3; ++axis) {
            heights[static_cast<std::size_t>(axis)].push_back(double{place.position[axis]});
        }
    }
    for (const std::vector<double>& of_axis : heights) {
        EXPECT_LT(off(of_axis, [](double h) { return 0.5 * (h + 1.0); }), kCritical);
    }
}

TEST(EmitterSurface, IsUniformOnABoxAndPointsOutwards) {
    const glm::vec3 half(0.5F, 2.0F, 0.1F);
    const AnimatedMesh box = movingBox(half);
    const EmitterSurface surface = surfaceOf(box.triangles, box.positions);
    std::vector<std::size_t> counts(24);
    std::vector<double> areas(24);
    for (std::size_t i = 0; i < 24; ++i) {
        const int axis = static_cast<int>(i / 8);
        areas[i] = double{half[(axis + 1) % 3]} * double{half[(axis + 2) % 3]};
    }
    for (const EmitterSurface::Place& place : drawn(surface)) {
        int axis = 0;
        while (axis < 2 && std::abs(place.normal[axis]) < 0.5F) {
            ++axis;
        }
        const float side = place.normal[axis] > 0.0F ? 1.0F : -1.0F;
        ASSERT_NEAR(place.position[axis], side * half[axis], 1e-6F) << "outwards, and in the face";
        const std::size_t quarter = (place.position[(axis + 1) % 3] > 0.0F ? 1U : 0U) +
                                    (place.position[(axis + 2) % 3] > 0.0F ? 2U : 0U);
        ++counts[static_cast<std::size_t>(axis) * 8 + (side > 0.0F ? 4U : 0U) + quarter];
    }
    EXPECT_LT(chi(counts, areas), 6.0);
}

// A straight pipe that is bent into a quarter of a torus: its outer side is stretched, R + r cos φ.
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
    for (const EmitterSurface::Place& place : drawn(surface)) {
        const glm::dvec3 p(place.position);
        const double phi = std::atan2(p.z, std::hypot(p.x, p.y) - kBend);
        around.push_back(phi < 0.0 ? phi + 2 * kPi : phi);
        along.push_back(std::atan2(p.y, p.x));
    }
    EXPECT_LT(off(along, [](double theta) { return theta / (0.5 * kPi); }), kCritical);
    const auto bent_share = [](double phi) {
        return (kBend * phi + kRadius * std::sin(phi)) / (2 * kPi * kBend);
    };
    EXPECT_LT(off(around, bent_share), kCritical);
    EXPECT_GT(off(around, [](double phi) { return phi / (2 * kPi); }), 20.0) << "areas at rest would be seen";
}

// The areas of a skinned, morphed mesh are those of its pose.
TEST(EmitterSurface, IsUniformOnAPosedMesh) {
    AnimatedMesh mesh = bendingTube(16, 20);
    MeshPose pose = poseAt(mesh, mesh.clips[0], 0.8);
    pose.weights[0] = 0.7F;
    const std::vector<glm::vec3> now = posed(mesh, pose);
    EmitterSurface surface = surfaceOf(mesh.triangles, mesh.positions);
    surface.move(now, now, 0.0);
    std::vector<double> areas;
    for (const glm::uvec3& t : mesh.triangles) {
        const glm::dvec3 p(now[t.x]);
        areas.push_back(glm::length(glm::cross(glm::dvec3(now[t.y]) - p, glm::dvec3(now[t.z]) - p)));
    }
    std::vector<std::size_t> counts(areas.size());
    for (const EmitterSurface::Place& place : drawn(surface, 200'000)) {
        std::size_t of = 0;
        double least = std::numeric_limits<double>::infinity();
        const glm::dvec3 p(place.position);
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            const glm::uvec3& t = mesh.triangles[i];
            const glm::dvec3 a(now[t.x]);
            const glm::dvec3 b(now[t.y]);
            const glm::dvec3 c(now[t.z]);
            // In the triangle, the areas with its sides add up to the whole.
            const double excess = glm::length(glm::cross(b - a, p - a)) +
                                  glm::length(glm::cross(c - b, p - b)) +
                                  glm::length(glm::cross(a - c, p - c)) - areas[i];
            if (excess < least) {
                least = excess;
                of = i;
            }
        }
        ASSERT_LT(least, 1e-6);
        ++counts[of];
    }
    EXPECT_LT(chi(counts, areas), 6.0);
}

// Points of a turning body go with ω × r; what a straight line makes of the arc is within the header's bounds.
TEST(EmitterSurface, MovesAsATurningBodyDoes) {
    const AnimatedMesh box = movingBox({0.5F, 0.3F, 0.2F});
    const glm::vec3 axis = glm::normalize(glm::vec3(1.0F, 2.0F, -1.0F));
    constexpr double kTurn = 3.0;  // radians a second
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
                << "in the middle of the step it is far better";
            ASSERT_GT(glm::dot(then[i].normal, exact[i].normal), 0.99999F);
        }
    }
}

TEST(EmitterSurface, WeightsAreADensityThatIsLinear) {
    const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
    const std::vector<glm::uvec3> two{{0, 1, 2}, {3, 4, 5}};
    // The shares of a corner that alone has a weight are those of a beta distribution, 6 x (1 − x).
    for (std::size_t corner = 0; corner < 3; ++corner) {
        std::vector<float> weights(6, 0.0F);
        weights[corner] = 0.3F;
        std::vector<double> shares;
        for (const EmitterSurface::Place& place : drawn(surfaceOf(two, corners, weights))) {
            const double x{place.position.x};
            const double y{place.position.y};
            ASSERT_LE(x + y, 1.000001) << "the other triangle has no weight";
            shares.push_back(corner == 0 ? 1.0 - x - y : corner == 1 ? x : y);
        }
        EXPECT_LT(off(shares, [](double x) { return x * x * (3.0 - 2.0 * x); }), kCritical);
    }
    // A triangle of thrice the mean weight has thrice the births.
    std::size_t near = 0;
    for (const EmitterSurface::Place& place :
         drawn(surfaceOf(two, corners, {1.0F, 0.5F, 0.3F, 0.1F, 0.2F, 0.3F}))) {
        near += place.position.x < 2.0F ? 1 : 0;
    }
    EXPECT_NEAR(static_cast<double>(near) / kCount, 0.75, 5 * std::sqrt(0.1875 / kCount));
}

TEST(EmitterSurface, GroupsOfAMeshAreItsJoints) {
    const AnimatedMesh mesh = bendingTube();
    const auto weights = groupWeights(mesh, "middle");
    ASSERT_TRUE(weights);
    for (const EmitterSurface::Place& place :
         drawn(surfaceOf(mesh.triangles, mesh.positions, *weights), 20'000)) {
        // Its weights begin at a third of the height; a triangle that straddles it reaches down by a ring.
        ASSERT_GE(place.position.y, 2.0F / 3.0F - 0.05F);
    }
    // Both joints' weights make up the whole.
    const auto others = groupWeights(mesh, "foot");
    ASSERT_TRUE(others);
    EXPECT_NEAR(surfaceOf(mesh.triangles, mesh.positions, *weights).area() +
                    surfaceOf(mesh.triangles, mesh.positions, *others).area(),
                surfaceOf(mesh.triangles, mesh.positions).area(), 1e-6);
    const auto none = groupWeights(mesh, "Head");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("'Head'; it has 'foot', 'middle'"), std::string::npos)
        << none.error().message;
    EXPECT_FALSE(groupWeights(mesh, ""));
}

TEST(EmitterSurface, RefusesWhatIsNoSurface) {
    const std::vector<glm::vec3> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const std::vector<glm::uvec3> one{{0, 1, 2}};
    const auto refused = [&](const std::vector<glm::uvec3>& triangles, std::vector<float> weights,
                             std::vector<glm::vec3> positions, const char* words) {
        const auto made = EmitterSurface::create(triangles, std::move(weights), std::move(positions));
        ASSERT_FALSE(made) << words;
        EXPECT_NE(made.error().message.find(words), std::string::npos) << made.error().message;
    };
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    refused({{0, 1, 3}}, {}, corners, "corner does not exist");
    refused(one, {1.0F}, corners, "one weight a position");
    refused(one, {1.0F, -1.0F, 1.0F}, corners, "weight");
    refused(one, {1.0F, kNan, 1.0F}, corners, "weight");
    refused(one, {0.0F, 0.0F, 0.0F}, corners, "no area");
    refused({}, {}, corners, "no area");
    refused({{0, 1, 1}}, {}, corners, "no area");
    refused(one, {}, {{0, 0, 0}, {1, 0, 0}, {kNan, 1, 0}}, "no area");
    refused(one, {}, {{0, 0, 0}, {1, 0, 0}, {kInfinity, 1, 0}}, "no area");
    // Tiny and huge ones are none the worse.
    for (const float scale : {1e-18F, 1e15F}) {
        EmitterSurface surface = surfaceOf(one, {corners[0], scale * corners[1], scale * corners[2]});
        Pcg32 random(1);
        const EmitterSurface::Place place = surface.draw(random, 0.0F);
        EXPECT_EQ(place.normal, glm::vec3(0, 0, 1));
        EXPECT_GT(place.position.x, 0.0F);
    }
}

// --- as an emitter has it

EmitterSettings settingsOf(EmitterSurface surface) {
    EmitterSettings settings;
    settings.shape = EmitterShape::kSurface;
    settings.surface = std::move(surface);
    settings.rate = 3000.0;
    EmitterAim& aim = settings.aim.emplace();
    aim.speed_min = 2.0F;
    aim.speed_max = 2.0F;
    return settings;
}

TEST(EmitterSurface, AnEmitterThrowsAlongTheNormalAndTakesOnItsVelocity) {
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
    ASSERT_EQ(emitter.placeVelocities().size(), births.size());
    EmitterMotion motion;
    // Scaled and turned as its body is, whose own speed comes on top.
    const glm::quat quarter = glm::angleAxis(float(kPi) / 2, glm::vec3(0, 1, 0));
    motion.body = {{0.0, {{0, 0, 0}, quarter, 3.0F}}, {1.0, {{0, 5, 0}, quarter, 3.0F}}};
    motion.inherit = 0.5F;
    const std::vector<Birth> own = births;
    carry(motion, 0.5, births, emitter.placeVelocities());
    for (std::size_t i = 0; i < births.size(); ++i) {
        EXPECT_NEAR(glm::length(own[i].velocity), 2.0F, 1e-5F);
        const glm::vec3 at_end = own[i].position + own[i].age * glm::vec3(1, 0, 2);
        const glm::vec3 from = glm::abs(at_end - glm::vec3(0.1F, 0, 0.2F)) - glm::vec3(0.5F, 0.3F, 0.2F);
        EXPECT_NEAR(std::max({from.x, from.y, from.z}), 0.0F, 1e-5F) << "on the box of its own moment";
        // x goes to −z and z to x.
        const glm::vec3 thrown = births[i].velocity - quarter * own[i].velocity;
        EXPECT_LT(glm::length(thrown - 0.5F * glm::vec3(3 * 2.0F, 5.0F, -3 * 1.0F)), 1e-4F);
    }
}

// Steps of half the length are the same births where the motion is a straight one, and as near as the header has it where not.
TEST(EmitterSurface, BirthsDoNotDependOnTheSteps) {
    const AnimatedMesh box = movingBox({0.5F, 0.3F, 0.2F});
    const auto birthsBy = [&](int steps, double turn) {
        Emitter emitter(settingsOf(surfaceOf(box.triangles, box.positions)), 5);
        std::vector<Birth> births;
        const double dt = 0.2 / steps;
        const auto at = [&](double time) {
            std::vector<glm::vec3> out;
            for (const glm::vec3& p : box.positions) {
                const double c = std::cos(turn * time);
                const double s = std::sin(turn * time);
                out.emplace_back(c * double{p.x} - s * double{p.y} + time, s * double{p.x} + c * double{p.y},
                                 p.z);
            }
            return out;
        };
        for (int step = 0; step < steps; ++step) {
            const std::size_t before = births.size();
            emitter.moveSurface(at(step * dt), at((step + 1) * dt), dt);
            emitter.emit(dt, 1000, births);
            for (std::size_t i = before; i < births.size(); ++i) {
                births[i].velocity = emitter.placeVelocities()[i - before];
            }
        }
        return births;
    };
    for (const double turn : {0.0, 4.0}) {
        const std::vector<Birth> coarse = birthsBy(10, turn);
        const std::vector<Birth> fine = birthsBy(40, turn);
        ASSERT_EQ(coarse.size(), 600U);
        ASSERT_EQ(fine.size(), coarse.size());
        const double arm = 0.62;
        for (std::size_t i = 0; i < fine.size(); ++i) {
            ASSERT_LE(double{glm::length(fine[i].position - coarse[i].position)},
                      arm * turn * turn * 0.02 * 0.02 / 8 + 1e-6);
            ASSERT_LE(double{glm::length(fine[i].velocity - coarse[i].velocity)},
                      arm * turn * turn * 0.025 / 2 + 1e-4);
        }
    }
}

TEST(EmitterSurface, WithoutAnAreaNothingIsBorn) {
    const AnimatedMesh box = movingBox({0.5F, 0.3F, 0.2F});
    EmitterSettings settings = settingsOf({});
    EXPECT_FALSE(Emitter::check(settings));
    settings.surface = surfaceOf(box.triangles, box.positions);
    ASSERT_TRUE(Emitter::check(settings));
    Emitter emitter(settings, 1);
    std::vector<Birth> births;
    // Flat as a line, then without numbers: due births find no room, and later ones are born.
    emitter.moveSurface(box.positions, std::vector<glm::vec3>(8, glm::vec3(1.0F)), 0.1);
    EXPECT_EQ(emitter.emit(0.1, 1000, births), 300U);
    emitter.moveSurface(box.positions,
                        std::vector<glm::vec3>(8, glm::vec3(std::numeric_limits<float>::infinity())), 0.1);
    EXPECT_EQ(emitter.emit(0.1, 1000, births), 300U);
    EXPECT_TRUE(births.empty());
    emitter.moveSurface(std::vector<glm::vec3>(8, glm::vec3(std::numeric_limits<float>::quiet_NaN())),
                        box.positions, 0.1);
    EXPECT_EQ(emitter.emit(0.1, 1000, births), 0U);
    ASSERT_EQ(births.size(), 300U);
    for (const Birth& birth : births) {
        EXPECT_TRUE(isValid(birth));
    }
}

}  // namespace
}  // namespace relief
