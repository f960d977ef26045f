// SPDX-License-Identifier: Apache-2.0
// The wobble by transform feedback against its formula; the caller's state.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <vector>

#include "runtime/gl/buffer_read.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/particles/random.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

struct Points {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
};

Points somePoints(std::size_t count) {
    Pcg32 random(11);
    Points points;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = random.signedUniform();
        const float y = random.signedUniform();
        points.positions.emplace_back(x, y, random.signedUniform());
        points.normals.push_back(onUnitSphere(random));
    }
    return points;
}

constexpr Wobble kSome{.amplitude = 0.2F, .frequency = 0.9F, .phase = 0.4F, .wavelength = 0.8F};

/// The sine's phase along an axis, by the formula of wobble_pass.h.
double phaseAt(int axis, double time, float coordinate) {
    const double rates[3] = {1.0, 1.25, 0.8};
    return 2.0 * std::numbers::pi *
               (double{coordinate} / double{kSome.wavelength} -
                rates[axis] * double{kSome.frequency} * time) +
           double{kSome.phase} + axis;
}
glm::vec3 wobbled(double time, const glm::vec3& p, const glm::vec3& normal) {
    const double sum =
        std::sin(phaseAt(0, time, p.x)) + std::sin(phaseAt(1, time, p.y)) + std::sin(phaseAt(2, time, p.z));
    return p + kSome.amplitude / 3.0F * static_cast<float>(sum) * normal;
}

class WobblePassGlTest : public GlTest {
  protected:
    static std::vector<glm::vec3> read(const WobblePass& pass) {
        std::vector<glm::vec3> values(pass.bytes() / sizeof(glm::vec3));
        EXPECT_TRUE(readBuffer(pass.buffer(), 0, std::as_writable_bytes(std::span(values))));
        return values;
    }
};
RELIEF_INSTANTIATE_GL_TESTS(WobblePassGlTest);

TEST_P(WobblePassGlTest, MatchesItsFormulaAndKeepsCallerState) {
    const Points points = somePoints(5000);
    const CallerState caller;
    auto pass = required(WobblePass::create(kSome, points.positions, points.normals));
    caller.expectKept("create");
    float moved = 0.0F;
    for (const double time : {0.0, 0.3, 777.7}) {
        pass.run(time);
        caller.expectKept("run");
        const std::vector<glm::vec3> gpu = read(pass);
        const std::vector<glm::vec3> all = relief::wobbled(kSome, points.positions, points.normals, time);
        ASSERT_EQ(gpu.size(), points.positions.size());
        ASSERT_EQ(all.size(), points.positions.size());
        for (std::size_t i = 0; i < gpu.size(); ++i) {
            const glm::vec3 cpu = wobbled(time, points.positions[i], points.normals[i]);
            ASSERT_LE(glm::length(all[i] - cpu), 1e-6F) << time << " " << i;
            ASSERT_LE(glm::length(gpu[i] - cpu), 2e-5F) << time << " " << i;
            moved = std::max(moved, glm::length(gpu[i] - points.positions[i]));
        }
    }
    EXPECT_GT(moved, 0.05F);  // the vertices do move
}

TEST_P(WobblePassGlTest, NormalsMatchTheMovedSurface) {
    // The plane z = 0 becomes z = f(x, y) = amplitude/3 · Σ sin(…), with normal (-df/dx, -df/dy, 1).
    Points points;
    std::vector<glm::vec3> wanted;
    const double time = 0.3;
    const double slope = -2.0 * std::numbers::pi / 3.0 * double{kSome.amplitude} / double{kSome.wavelength};
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 p(0.03F * static_cast<float>(i), 0.7F - 0.05F * static_cast<float>(i), 0.0F);
        points.positions.push_back(p);
        points.normals.emplace_back(0.0F, 0.0F, 1.0F);
        wanted.push_back(glm::normalize(glm::vec3(slope * std::cos(phaseAt(0, time, p.x)),
                                                  slope * std::cos(phaseAt(1, time, p.y)), 1.0)));
    }
    auto pass = required(
        WobblePass::create(kSome, points.positions, points.normals, VertexOutput::kPositionsAndNormals));
    pass.run(time);
    const std::vector<glm::vec3> gpu = read(pass);
    ASSERT_EQ(gpu.size(), 2 * wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_LE(glm::length(gpu[2 * i + 1] - wanted[i]), 2e-3F) << i;
    }
}

TEST_P(WobblePassGlTest, InvalidArgumentsAreRejected) {
    const Points points = somePoints(3);
    const auto refused = [&](const Wobble& wobble, std::span<const glm::vec3> positions,
                             std::span<const glm::vec3> normals) {
        expectError(WobblePass::create(wobble, positions, normals), ErrorCode::kUsage);
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    refused(kSome, {}, {});
    refused(kSome, points.positions, {});
    refused(kSome, points.positions, std::span(points.normals).first(2));
    refused({.amplitude = nan}, points.positions, points.normals);
    refused({.phase = nan}, points.positions, points.normals);
    refused({.frequency = -1.0F}, points.positions, points.normals);
    refused({.wavelength = 0.0F}, points.positions, points.normals);
}

}  // namespace
}  // namespace relief
