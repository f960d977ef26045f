// SPDX-License-Identifier: Apache-2.0
// Depth maps rendered from meshes with closed-form texels, against the CPU's encoders.
#include "runtime/depth_maps/depth_map_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <span>
#include <vector>

#include "formats/normal_index.h"
#include "formats/plane.h"
#include "runtime/gl/gl_functions.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/depth_maps/read_texels.h"
#include "tests/runtime/gl/caller_state.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

/// z = height(x, y) over a rectangle of n × n squares; normals along +z.
AnimatedMesh sheet(const glm::vec2& low, const glm::vec2& high, std::uint32_t n,
                   const std::function<float(float, float)>& height) {
    AnimatedMesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const float x = low.x + (high.x - low.x) * static_cast<float>(i) / static_cast<float>(n);
            const float y = low.y + (high.y - low.y) * static_cast<float>(j) / static_cast<float>(n);
            mesh.positions.emplace_back(x, y, height(x, y));
            if (i < n && j < n) {
                const std::uint32_t k = j * (n + 1) + i;
                mesh.triangles.emplace_back(k, k + 1, k + n + 2);
                mesh.triangles.emplace_back(k, k + n + 2, k + n + 1);
            }
        }
    }
    return mesh;
}

/// Views along +z through [−1, 1]³, so that map depth is (z + 1)/2.
DepthMap alongZ(std::uint32_t size) {
    DepthMap map;
    map.format = MapFormat::kFrontBackFixed;
    map.compare = Compare::kBoth;
    map.decode = Decode::kPlane;
    map.width = map.height = size;
    for (int k = 0; k < 3; ++k) {
        map.object_to_map.row[k] = {0.0F, 0.0F, 0.0F, 0.5F};
        map.object_to_map.row[k][k] = 0.5F;
        map.object_per_map[k] = 2.0F;
    }
    return map;
}

class DepthMapRendererGlTest : public GlTest {
  protected:
    static GpuMesh upload(const AnimatedMesh& mesh) {
        return required(GpuMesh::create(mesh.positions, mesh.triangles));
    }

    static DepthMap render(GpuMesh& mesh, DepthMap map) {
        const DepthMapRenderer renderer = required(DepthMapRenderer::create(map.width, map.height));
        renderer.render(mesh, map);
        map.texels = readTexels(renderer);
        return map;
    }
};

/// x of the centre of a texel in [−1, 1].
double centre(std::uint32_t i, std::uint32_t size) {
    return -1.0 + (i + 0.5) * 2.0 / size;
}

TEST_P(DepthMapRendererGlTest, PlanesAreExact) {
    constexpr std::uint32_t kSize = 16;
    constexpr float kZ = 0.25F;
    // Half of the image, with edges between texel centres, so that coverage is unambiguous.
    GpuMesh mesh = upload(sheet({-0.5F, -0.25F}, {0.5F, 0.75F}, 3, [](float, float) { return kZ; }));
    const DepthMap map = render(mesh, alongZ(kSize));
    // 0.625 lies between two codes, 40958 and 40959: planes are rounded towards their viewer.
    const Surface front{40958.0F / 65534.0F, {0.0F, 0.0F, -1.0F}};
    const Surface back{40959.0F / 65534.0F, {0.0F, 0.0F, 1.0F}};
    std::vector<std::byte> want(texelSize(map.format));
    for (std::uint32_t y = 0; y < kSize; ++y) {
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const bool covered = std::abs(centre(x, kSize)) < 0.5 && std::abs(centre(y, kSize) - 0.25) < 0.5;
            encodeTexel(map.format, covered ? Texel{front, back} : Texel{}, want);
            const auto got = map.texelAt(0, x, y);
            ASSERT_TRUE(std::equal(want.begin(), want.end(), got.begin())) << x << " " << y;
        }
    }
}

TEST_P(DepthMapRendererGlTest, TiltedPlanesHaveExactDepthAndNormal) {
    constexpr std::uint32_t kSize = 128;
    for (const glm::dvec2& slope : {glm::dvec2(0.3, -0.2), glm::dvec2(-0.7, 0.2), glm::dvec2(0.0, 0.9)}) {
        const auto height = [&](double x, double y) { return slope.x * x + slope.y * y + 0.03; };
        GpuMesh mesh = upload(sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 17, [&](float x, float y) {
            return static_cast<float>(height(double{x}, double{y}));
        }));
        const glm::vec3 up = glm::vec3(glm::normalize(glm::dvec3(-slope.x, -slope.y, 1.0)));
        const DepthMap map = render(mesh, alongZ(kSize));
        for (std::uint32_t y = 1; y + 1 < kSize; ++y) {
            for (std::uint32_t x = 1; x + 1 < kSize; ++x) {
                const double depth = 0.5 * (height(centre(x, kSize), centre(y, kSize)) + 1.0);
                const Texel texel = decodeTexel(map.format, map.texelAt(0, x, y));
                ASSERT_TRUE(texel.front && texel.back) << x << " " << y;
                // At most one code step outwards, plus the float rounding of the corners.
                constexpr double kHalfStep = 0.5 / 65534.0;
                ASSERT_NEAR(texel.front->depth, depth - kHalfStep, kHalfStep + 1e-6) << x << " " << y;
                ASSERT_NEAR(texel.back->depth, depth + kHalfStep, kHalfStep + 1e-6) << x << " " << y;
                ASSERT_EQ(encodeNormal(texel.front->normal), encodeNormal(-up)) << x << " " << y;
                ASSERT_EQ(encodeNormal(texel.back->normal), encodeNormal(up)) << x << " " << y;
            }
        }
    }
}

TEST_P(DepthMapRendererGlTest, SteepPlanesFaceTheViewerAndContainTheSurface) {
    // One steep sheet at every cosine from 0.5 down to 0.002: the stored distance at the surface point is 0.
    constexpr std::uint32_t kSize = 64;
    int faced = 0;
    for (const double slope : {1.7, 10.0, 25.0, 31.0, 33.0, 60.0, 200.0}) {
        const double width = 0.9 / slope;
        GpuMesh mesh = upload(sheet({static_cast<float>(-width), -1.0F}, {static_cast<float>(width), 1.0F}, 2,
                                    [&](float x, float) { return static_cast<float>(slope * double{x}); }));
        // Eight times finer along x, so that the sheet covers texels.
        DepthMap map = alongZ(kSize);
        map.object_to_map.row[0] = {4.0F, 0.0F, 0.0F, 0.5F};
        map.object_per_map.x = 0.25F;
        map = render(mesh, std::move(map));
        int covered = 0;
        for (std::uint32_t y = 1; y + 1 < kSize; ++y) {
            for (std::uint32_t x = 1; x + 1 < kSize; ++x) {
                const double at = -0.125 + 0.25 * (x + 0.5) / kSize;
                const glm::vec3 on(static_cast<float>(at), static_cast<float>(centre(y, kSize)),
                                   static_cast<float>(slope * at));
                const Texel texel = decodeTexel(map.format, map.texelAt(0, x, y));
                ASSERT_EQ(texel.front.has_value(), std::abs(at) < width) << slope << " " << x << " " << y;
                if (!texel.front) {
                    continue;
                }
                ++covered;
                const auto voted = vote(map, on);
                ASSERT_TRUE(voted);
                // At most one code step along the normal.
                ASSERT_NEAR(voted->distance, 0.0F, 1e-4F) << slope << " " << x << " " << y;
                const float cosine = std::abs(texel.front->normal.z);
                ASSERT_GE(cosine, kPlaneCosineMin) << slope;
                faced += cosine == 1.0F ? 1 : 0;
            }
        }
        EXPECT_GT(covered, 0) << slope;
        // The border is empty.
        for (std::uint32_t i = 0; i < kSize; ++i) {
            for (const glm::uvec2& at : {glm::uvec2(i, 0), {i, kSize - 1}, {0, i}, {kSize - 1, i}}) {
                EXPECT_FALSE(decodeTexel(map.format, map.texelAt(0, at.x, at.y)).front);
            }
        }
    }
    EXPECT_GT(faced, 100);
}

TEST_P(DepthMapRendererGlTest, RaysFromInsideLeaveTexelsEmpty) {
    GpuMesh mesh = upload(sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 1, [](float, float) { return 0.25F; }));
    DepthMap frame = alongZ(8);
    // The view sees the inner side.
    for (const bool free : {true, false}) {
        frame.encloses = free;
        const DepthMap map = render(mesh, frame);
        EXPECT_EQ(decodeTexel(map.format, map.texelAt(0, 3, 4)).front.has_value(), free);
    }
}

TEST_P(DepthMapRendererGlTest, IsIndependentOfScale) {
    // Powers of two, so that rounding does not change.
    std::vector<std::byte> first;
    for (const int power : {0, -40, 45}) {
        AnimatedMesh scaled =
            sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 9, [](float x, float y) { return 0.5F * x * y; });
        for (glm::vec3& p : scaled.positions) {
            p *= std::ldexp(1.0F, power);
        }
        DepthMap frame = alongZ(32);
        for (int k = 0; k < 3; ++k) {
            frame.object_to_map.row[k][k] *= std::ldexp(1.0F, -power);
        }
        GpuMesh mesh = upload(scaled);
        const DepthMap map = render(mesh, frame);
        first = first.empty() ? map.texels : first;
        EXPECT_TRUE(map.texels == first) << power;
    }
}

TEST_P(DepthMapRendererGlTest, VerticesMoveAndTheSurfaceMotionIsCorrect) {
    const AnimatedMesh before = movingBox({0.5F, 0.5F, 0.5F});
    AnimatedMesh after = before;
    const glm::vec3 way(0.125F, -0.0625F, 0.25F);
    for (glm::vec3& p : after.positions) {
        p += way;
    }
    const DepthMap frame = alongZ(16);
    GpuMesh moved = upload(before);
    GpuMesh made = upload(after);
    const std::uint64_t revision = moved.revision();
    EXPECT_FALSE(render(moved, frame).texels == render(made, frame).texels);
    // From a GPU buffer, after other data in it.
    const GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    const std::size_t bytes = after.positions.size() * sizeof(glm::vec3);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes + 8), nullptr, GL_STATIC_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 8, static_cast<GLsizeiptr>(bytes), after.positions.data());
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    ASSERT_TRUE(moved.setPositions(buffer.name(), 8));
    EXPECT_NE(moved.revision(), revision);
    EXPECT_TRUE(render(moved, frame).texels == render(made, frame).texels);

    const DepthMapRenderer renderer = required(DepthMapRenderer::create(16, 16));
    for (const bool settled : {false, true}) {
        if (settled) {
            moved.settle();
        }
        renderer.render(moved, frame);
        const glm::vec3 want = settled ? glm::vec3(0.0F) : way;
        std::vector<float> motion[2];
        for (int i = 0; i < 2; ++i) {
            motion[i].resize(std::size_t{16} * 16 * 4);
            glBindFramebuffer(GL_READ_FRAMEBUFFER, renderer.framebuffer());
            glReadBuffer(GL_COLOR_ATTACHMENT1 + static_cast<GLenum>(i));
            glReadPixels(0, 0, 16, 16, GL_RGBA, GL_FLOAT, motion[i].data());
        }
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
        const std::vector<std::byte> texels = readTexels(renderer);
        int covered = 0;
        for (std::size_t i = 0; i < 256; ++i) {
            const Texel texel = decodeTexel(frame.format, std::span(texels).subspan(8 * i, 8));
            covered += texel.front ? 1 : 0;
            for (std::size_t end = 0; end < 2; ++end) {
                const glm::vec3 got(motion[0][4 * i + end], motion[0][4 * i + 2 + end],
                                    motion[1][4 * i + end]);
                const glm::vec3 here = (end == 0 ? texel.front : texel.back) ? want : glm::vec3(0.0F);
                EXPECT_LT(glm::length(got - here), 1e-6F) << i << " " << end;
            }
        }
        EXPECT_GT(covered, 40);
    }
}

TEST_P(DepthMapRendererGlTest, EveryTriangleOwnsItsSlot) {
    // A fan, in which all triangles share a vertex; and triangles without a vertex of their own.
    AnimatedMesh fan;
    fan.positions.emplace_back(0.0F, 0.0F, 0.5F);
    for (int i = 0; i <= 12; ++i) {
        const double angle = 2.0 * 3.14159265358979 * i / 12.0;
        fan.positions.emplace_back(0.9 * std::cos(angle), 0.9 * std::sin(angle), i % 2 == 0 ? -0.5 : 0.0);
    }
    for (std::uint32_t i = 1; i <= 12; ++i) {
        fan.triangles.emplace_back(0, i, i + 1);
        fan.triangles.emplace_back(i, i + 1, 0);
        fan.triangles.emplace_back(i + 1, 0, i);
    }
    GpuMesh mesh = upload(fan);
    EXPECT_EQ(mesh.triangleCount(), 36U);
    EXPECT_LE(mesh.slotCount(), 36U + 14U);
    // Each texel has the normal of a triangle that contains its centre, or is within 1/100 texel of it.
    const DepthMap map = render(mesh, alongZ(63));
    int covered = 0;
    for (std::uint32_t i = 0; i < 63 * 63; ++i) {
        const Texel texel = decodeTexel(map.format, map.texelAt(0, i % 63, i / 63));
        if (!texel.front) {
            continue;
        }
        ++covered;
        const glm::vec2 at(centre(i % 63, 63), centre(i / 63, 63));
        const bool found = std::any_of(fan.triangles.begin(), fan.triangles.end(), [&](const glm::uvec3& t) {
            const glm::vec3& a = fan.positions[t.x];
            const glm::vec3& b = fan.positions[t.y];
            const glm::vec3& c = fan.positions[t.z];
            const glm::vec3 n = glm::normalize(glm::cross(b - a, c - a));
            const auto side = [&](const glm::vec3& from, const glm::vec3& to) {
                const glm::vec2 along = glm::normalize(glm::vec2(to - from));
                return along.x * (at.y - from.y) - along.y * (at.x - from.x);
            };
            const float turn = n.z < 0.0F ? -1.0F : 1.0F;
            const float least = std::min({turn * side(a, b), turn * side(b, c), turn * side(c, a)});
            return least > -0.02F / 63.0F &&
                   glm::length(n - turn * glm::sign(texel.front->normal.z) * texel.front->normal) < 0.03F;
        });
        EXPECT_TRUE(found) << i;
    }
    EXPECT_GT(covered, 1500);
}

TEST_P(DepthMapRendererGlTest, CallerStateIsKeptAndIgnored) {
    const AnimatedMesh mesh =
        sheet({-0.8F, -0.7F}, {0.6F, 0.8F}, 3, [](float x, float y) { return 0.5F * x * y; });
    const auto run = [&](const std::function<void(const char*)>& check) {
        GpuMesh gpu_mesh = upload(mesh);
        check("GpuMesh::create");
        EXPECT_TRUE(gpu_mesh.setPositions(mesh.positions));
        check("GpuMesh::setPositions");
        const DepthMap map = render(gpu_mesh, alongZ(16));
        check("DepthMapRenderer");
        return map.texels;
    };
    const std::vector<std::byte> plain = run([](const char*) {});
    EXPECT_NE(plain, std::vector<std::byte>(plain.size())) << "nothing was drawn";
    const CallerState caller;
    glDepthRangef(0.75F, 0.25F);
    if (!isGles()) {
        glProvokingVertex(GL_FIRST_VERTEX_CONVENTION);
        glEnable(GL_DEPTH_CLAMP);
    }
    EXPECT_TRUE(run([&](const char* call) { caller.expectKept(call); }) == plain);
    std::array<GLfloat, 2> range{};
    glGetFloatv(GL_DEPTH_RANGE, range.data());
    EXPECT_EQ(range, (std::array<GLfloat, 2>{0.75F, 0.25F}));
    if (!isGles()) {
        GLint provoking = 0;
        glGetIntegerv(GL_PROVOKING_VERTEX, &provoking);
        EXPECT_EQ(provoking, static_cast<GLint>(GL_FIRST_VERTEX_CONVENTION));
        EXPECT_EQ(glIsEnabled(GL_DEPTH_CLAMP), GL_TRUE);
    }
}

TEST_P(DepthMapRendererGlTest, InvalidArgumentsAreRejected) {
    const AnimatedMesh good = movingBox({0.5F, 0.5F, 0.5F});
    AnimatedMesh bad = good;
    bad.positions[3].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(GpuMesh::create(bad.positions, bad.triangles).error().code, ErrorCode::kInvalidInput);
    EXPECT_EQ(GpuMesh::create(good.positions, {}).error().code, ErrorCode::kInvalidInput);
    bad = good;
    bad.triangles[5].z = 8;
    EXPECT_EQ(GpuMesh::create(bad.positions, bad.triangles).error().code, ErrorCode::kInvalidInput);

    GpuMesh mesh = upload(good);
    EXPECT_EQ(mesh.setPositions(std::span(good.positions).first(7)).error().code, ErrorCode::kUsage);
    bad = good;
    bad.positions[7].x = std::numeric_limits<float>::infinity();
    EXPECT_EQ(mesh.setPositions(bad.positions).error().code, ErrorCode::kInvalidInput);
    const GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, 96, nullptr, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    for (const auto& [name, offset] :
         {std::pair(GLuint{0}, std::size_t{0}), std::pair(GLuint{12345}, std::size_t{0}),
          std::pair(buffer.name(), std::size_t{4}), std::pair(buffer.name(), std::size_t{2}),
          std::pair(buffer.name(), std::numeric_limits<std::size_t>::max() - 3)}) {
        EXPECT_EQ(mesh.setPositions(name, offset).error().code, ErrorCode::kUsage) << offset;
    }

    EXPECT_EQ(DepthMapRenderer::create(1U << 20, 16).error().code, ErrorCode::kLimit);
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(DepthMapRendererGlTest);

}  // namespace relief
