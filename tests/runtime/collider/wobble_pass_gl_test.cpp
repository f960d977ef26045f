// A wobble by transform feedback against its formula; the caller's state.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "runtime/collider/wobble_pass.h"
#include "runtime/gl/buffer_read.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

struct Points {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;
};

Points somePoints(std::size_t count) {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> in(-1.0F, 1.0F);
    Points points;
    while (points.positions.size() < count) {
        const glm::vec3 n(in(random), in(random), in(random));
        if (glm::length(n) > 0.1F && glm::length(n) < 1.0F) {
            points.positions.emplace_back(in(random), in(random), in(random));
            points.normals.push_back(glm::normalize(n));
        }
    }
    return points;
}

constexpr Wobble kSome{.amplitude = 0.2F, .frequency = 0.9F, .phase = 0.4F, .wavelength = 0.8F};

/// The formula of wobble_pass.h.
glm::vec3 wobbled(const Wobble& wobble, double time, const glm::vec3& p, const glm::vec3& normal) {
    const double rates[3] = {1.0, 1.25, 0.8};
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
        sum += std::sin(2.0 * std::numbers::pi *
                            (static_cast<double>(p[k] / wobble.wavelength) -
                             rates[k] * static_cast<double>(wobble.frequency) * time) +
                        static_cast<double>(wobble.phase) + k);
    }
    return p + wobble.amplitude / 3.0F * static_cast<float>(sum) * normal;
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

TEST_P(WobblePassGlTest, FollowsItsFormula) {
    const Points points = somePoints(5000);
    auto pass = WobblePass::create(kSome, points.positions, points.normals);
    ASSERT_TRUE(pass) << pass.error().message;
    float moved = 0.0F;
    for (const double time : {0.0, 0.3, 777.7}) {
        pass->run(time);
        const std::vector<glm::vec3> gpu = read(*pass);
        const std::vector<glm::vec3> all = relief::wobbled(kSome, points.positions, points.normals, time);
        ASSERT_EQ(gpu.size(), points.positions.size());
        ASSERT_EQ(all.size(), points.positions.size());
        for (std::size_t i = 0; i < gpu.size(); ++i) {
            const glm::vec3 cpu = wobbled(kSome, time, points.positions[i], points.normals[i]);
            ASSERT_LE(glm::length(all[i] - cpu), 1e-6F) << time << " " << i;
            ASSERT_LE(glm::length(gpu[i] - cpu), 2e-5F) << time << " " << i;
            moved = std::max(moved, glm::length(gpu[i] - points.positions[i]));
        }
    }
    EXPECT_GT(moved, 0.05F);  // it does something
}

TEST_P(WobblePassGlTest, NormalsAreThoseOfTheMovedSurface) {
    // The plane z = 0 becomes z = f(x, y) = amplitude/3 · Σ sin(…), of normal (-df/dx, -df/dy, 1).
    Points points;
    std::vector<glm::vec3> wanted;
    const float time = 0.3F;
    const double number = 2.0 * std::numbers::pi / static_cast<double>(kSome.wavelength);
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 p(0.03F * static_cast<float>(i), 0.7F - 0.05F * static_cast<float>(i), 0.0F);
        points.positions.push_back(p);
        points.normals.emplace_back(0.0F, 0.0F, 1.0F);
        glm::vec3 normal(0.0F, 0.0F, 1.0F);
        const double rates[2] = {1.0, 1.25};
        for (int k = 0; k < 2; ++k) {
            normal[k] = static_cast<float>(
                -static_cast<double>(kSome.amplitude) / 3.0 * number *
                std::cos(number * static_cast<double>(p[k]) -
                         2.0 * std::numbers::pi * rates[k] * static_cast<double>(kSome.frequency * time) +
                         static_cast<double>(kSome.phase) + k));
        }
        wanted.push_back(glm::normalize(normal));
    }
    auto pass =
        WobblePass::create(kSome, points.positions, points.normals, VertexOutput::kPositionsAndNormals);
    ASSERT_TRUE(pass) << pass.error().message;
    pass->run(static_cast<double>(time));
    const std::vector<glm::vec3> gpu = read(*pass);
    ASSERT_EQ(gpu.size(), 2 * wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_LE(glm::length(gpu[2 * i + 1] - wanted[i]), 2e-3F) << i;
    }
}

TEST_P(WobblePassGlTest, WhatMakesNoSenseIsRefused) {
    const Points points = somePoints(3);
    const auto refused = [&](const Wobble& wobble, std::span<const glm::vec3> positions,
                             std::span<const glm::vec3> normals) {
        const auto pass = WobblePass::create(wobble, positions, normals);
        ASSERT_FALSE(pass);
        EXPECT_EQ(pass.error().code, ErrorCode::kUsage);
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

TEST_P(WobblePassGlTest, TheCallersStateIsKept) {
    const Points points = somePoints(10);
    const CallerState caller;
    auto pass = WobblePass::create(kSome, points.positions, points.normals);
    ASSERT_TRUE(pass) << pass.error().message;
    caller.expectKept("create");
    pass->run(0.2);
    caller.expectKept("run");
    EXPECT_EQ(read(*pass).size(), points.positions.size());
}

}  // namespace
}  // namespace relief
