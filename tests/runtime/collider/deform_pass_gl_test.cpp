// Deformations by transform feedback against their twins on the CPU; a caller's own; the caller's state.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "runtime/collider/deform_pass.h"
#include "runtime/gl/gl_functions.h"
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

Deformation some(DeformKind kind) {
    Deformation d;
    d.kind = kind;
    d.amplitude = kind == DeformKind::kWobble ? 0.2F : 2.5F;
    d.frequency = 0.9F;
    d.phase = 0.4F;
    d.center = {0.1F, -0.2F, 0.3F};
    d.axis = glm::normalize(glm::vec3(0.2F, 1.0F, -0.4F));
    d.along = glm::normalize(glm::cross(d.axis, glm::vec3(0.0F, 0.0F, 1.0F)));
    d.range_low = -0.5F;
    d.range_high = 0.7F;
    d.wavelength = 0.8F;
    return d;
}

class DeformPassGlTest : public GlTest {
  protected:
    static std::vector<glm::vec3> read(const DeformPass& pass) {
        std::vector<glm::vec3> values(pass.bytes() / sizeof(glm::vec3));
        GLint bound = 0;
        glGetIntegerv(GL_ARRAY_BUFFER_BINDING, &bound);
        glBindBuffer(GL_ARRAY_BUFFER, pass.buffer().name());
        const void* from =
            glMapBufferRange(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(pass.bytes()), GL_MAP_READ_BIT);
        EXPECT_NE(from, nullptr);
        std::memcpy(values.data(), from, pass.bytes());
        glUnmapBuffer(GL_ARRAY_BUFFER);
        glBindBuffer(GL_ARRAY_BUFFER, static_cast<GLuint>(bound));
        return values;
    }
};
RELIEF_INSTANTIATE_GL_TESTS(DeformPassGlTest);

TEST_P(DeformPassGlTest, IsItsTwinOnTheCpu) {
    const Points points = somePoints(5000);
    for (const DeformKind kind : {DeformKind::kBend, DeformKind::kTwist, DeformKind::kWobble}) {
        const Deformation deformation = some(kind);
        auto pass = DeformPass::create(deformation, points.positions, points.normals);
        ASSERT_TRUE(pass) << pass.error().message;
        float moved = 0.0F;
        for (const double time : {0.0, 0.3, 777.7}) {
            pass->run(time);
            const std::vector<glm::vec3> gpu = read(*pass);
            const DeformMoment moment = momentOf(deformation, time);
            ASSERT_EQ(gpu.size(), points.positions.size());
            for (std::size_t i = 0; i < gpu.size(); ++i) {
                const glm::vec3 cpu = deform(deformation, moment, points.positions[i], points.normals[i]);
                ASSERT_LE(glm::length(gpu[i] - cpu), 2e-5F)
                    << static_cast<int>(kind) << " " << time << " " << i;
                moved = std::max(moved, glm::length(gpu[i] - points.positions[i]));
            }
        }
        EXPECT_GT(moved, 0.05F);  // it does something
    }
}

TEST_P(DeformPassGlTest, ThePoseComesLast) {
    const Points points = somePoints(100);
    const Deformation deformation = some(DeformKind::kTwist);
    auto pass = DeformPass::create(deformation, points.positions, {});
    ASSERT_TRUE(pass) << pass.error().message;
    const Pose pose{
        {3.0F, -1.0F, 2.0F}, glm::angleAxis(0.7F, glm::normalize(glm::vec3(1.0F, 2.0F, 3.0F))), 1.5F};
    pass->run(0.3, pose);
    const std::vector<glm::vec3> gpu = read(*pass);
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        const glm::vec3 cpu =
            toWorld(pose, deform(deformation, momentOf(deformation, 0.3), points.positions[i], {}));
        EXPECT_LE(glm::length(gpu[i] - cpu), 2e-5F);
    }
}

TEST_P(DeformPassGlTest, NormalsAreThoseOfTheDeformedSurface) {
    // On a cylinder about y that is twisted by a(y): p = (sin(u + a), y, cos(u + a)) has the normal (sin, 0,
    // cos) still, for a turn keeps circles; on the plane z = 0 that is twisted, n = dp/dx × dp/dy.
    Deformation twist;
    twist.kind = DeformKind::kTwist;
    twist.amplitude = 1.2F;
    twist.phase = 1.5707963F;  // at its greatest at time 0
    twist.range_low = -1.0F;
    twist.range_high = 1.0F;
    Points points;
    std::vector<glm::vec3> wanted;
    for (int i = 0; i < 60; ++i) {
        const float u = 0.1F * static_cast<float>(i);
        const float y = -0.9F + 0.03F * static_cast<float>(i);
        const float a = 0.6F * (y + 1.0F);
        points.positions.emplace_back(std::sin(u), y, std::cos(u));
        points.normals.emplace_back(std::sin(u), 0.0F, std::cos(u));
        wanted.emplace_back(std::sin(u + a), 0.0F, std::cos(u + a));
        points.positions.emplace_back(0.5F, y, 0.0F);
        points.normals.emplace_back(0.0F, 0.0F, 1.0F);
        const glm::vec3 along_x(std::cos(a), 0.0F, -std::sin(a));
        const glm::vec3 along_y(-0.3F * std::sin(a), 1.0F, -0.3F * std::cos(a));
        wanted.push_back(glm::normalize(glm::cross(along_x, along_y)));
    }
    auto pass =
        DeformPass::create(twist, points.positions, points.normals, DeformPass::Output::kPositionsAndNormals);
    ASSERT_TRUE(pass) << pass.error().message;
    pass->run(0.0);
    const std::vector<glm::vec3> gpu = read(*pass);
    ASSERT_EQ(gpu.size(), 2 * wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        EXPECT_LE(glm::length(gpu[2 * i + 1] - wanted[i]), 2e-3F) << i;
    }
}

TEST_P(DeformPassGlTest, WhatMakesNoSenseIsRefused) {
    const Points points = somePoints(3);
    const auto refused = [&](DeformKind kind, std::span<const glm::vec3> positions,
                             std::span<const glm::vec3> normals, DeformPass::Output output) {
        const auto pass = DeformPass::create(some(kind), positions, normals, output);
        ASSERT_FALSE(pass);
        EXPECT_EQ(pass.error().code, ErrorCode::kUsage);
    };
    using enum DeformPass::Output;
    refused(DeformKind::kTwist, {}, {}, kPositions);
    refused(DeformKind::kWobble, points.positions, {}, kPositions);
    refused(DeformKind::kTwist, points.positions, {}, kPositionsAndNormals);
    refused(DeformKind::kTwist, points.positions, std::span(points.normals).first(2), kPositions);
    Deformation wrong = some(DeformKind::kTwist);
    wrong.axis = glm::vec3(0.0F);
    EXPECT_FALSE(DeformPass::create(wrong, points.positions, {}));
}

TEST_P(DeformPassGlTest, TheCallersStateIsKept) {
    const Points points = somePoints(10);
    GLuint buffers[2] = {};
    glGenBuffers(2, buffers);
    for (const GLuint buffer : buffers) {
        glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffer);
        glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 256, nullptr, GL_STATIC_DRAW);
    }
    glBindBufferRange(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffers[0], 64, 128);
    glBindBuffer(GL_TRANSFORM_FEEDBACK_BUFFER, buffers[1]);
    glEnable(GL_RASTERIZER_DISCARD);
    auto pass = DeformPass::create(some(DeformKind::kBend), points.positions, {});
    ASSERT_TRUE(pass) << pass.error().message;
    pass->run(0.2);
    GLint generic = 0;
    GLint first = 0;
    GLint64 start = 0;
    GLint64 size = 0;
    glGetIntegerv(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, &generic);
    glGetIntegeri_v(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING, 0, &first);
    glGetInteger64i_v(GL_TRANSFORM_FEEDBACK_BUFFER_START, 0, &start);
    glGetInteger64i_v(GL_TRANSFORM_FEEDBACK_BUFFER_SIZE, 0, &size);
    EXPECT_EQ(static_cast<GLuint>(generic), buffers[1]);
    EXPECT_EQ(static_cast<GLuint>(first), buffers[0]);
    EXPECT_EQ(start, 64);
    EXPECT_EQ(size, 128);
    EXPECT_TRUE(glIsEnabled(GL_RASTERIZER_DISCARD));
    GLint program = -1;
    glGetIntegerv(GL_CURRENT_PROGRAM, &program);
    EXPECT_EQ(program, 0);
    EXPECT_EQ(read(*pass).size(), points.positions.size());
    glDeleteBuffers(2, buffers);
}

}  // namespace
}  // namespace relief
