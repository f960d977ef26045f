// Depth maps rendered from meshes whose every texel is known in closed form, against the CPU's encoders.
#include "runtime/depth_maps/depth_map_renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "formats/normal_index.h"
#include "formats/plane.h"
#include "runtime/gl/gl_functions.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

struct Mesh {
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
};

/// z = height(x, y) over a rectangle, of n × n squares; normals +z.
Mesh sheet(const glm::vec2& low, const glm::vec2& high, std::uint32_t n,
           const std::function<float(float, float)>& height) {
    Mesh mesh;
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

/// An axis-aligned box round the origin, normals outwards, each face one square.
Mesh box(const glm::vec3& half) {
    Mesh mesh;
    for (int corner = 0; corner < 8; ++corner) {
        mesh.positions.emplace_back((corner & 1) != 0 ? half.x : -half.x,
                                    (corner & 2) != 0 ? half.y : -half.y,
                                    (corner & 4) != 0 ? half.z : -half.z);
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

/// Looks along +z through [−1, 1]³, so that map depth is (z + 1)/2.
DepthMapFrame alongZ(MapFormat format, Compare compare, std::uint32_t size,
                     Decode decode = Decode::kProjected) {
    DepthMapFrame frame;
    frame.format = format;
    frame.compare = isFrontBack(format) ? Compare::kBoth : compare;
    frame.decode = decode;
    frame.width = frame.height = size;
    const bool cube = format == MapFormat::kCube8;
    frame.origin = cube ? glm::dvec3(0.0) : glm::dvec3(-1.0);
    for (int k = 0; k < 3; ++k) {
        frame.axis[k] = glm::dvec3(0.0);
        frame.axis[k][k] = cube ? 1.0 : 2.0;
    }
    return frame;
}

constexpr MapFormat kOrthographic[] = {MapFormat::kFloat32, MapFormat::kFixed8, MapFormat::kFrontBackHalf,
                                       MapFormat::kFrontBackFixed};

class DepthMapRendererGlTest : public GlTest {
  protected:
    void SetUp() override {
        GlTest::SetUp();
        auto renderer = DepthMapRenderer::create();
        ASSERT_TRUE(renderer);
        renderer_ = std::move(*renderer);
    }
    void TearDown() override {
        renderer_ = {};
        GlTest::TearDown();
    }

    static GpuMesh upload(const Mesh& mesh, const GpuMeshOptions& options = {}) {
        auto gpu_mesh = GpuMesh::create(mesh.positions, mesh.triangles, options);
        if (!gpu_mesh) {
            ADD_FAILURE() << gpu_mesh.error().message;
            std::abort();
        }
        return std::move(*gpu_mesh);
    }

    DepthMap render(GpuMesh& mesh, const DepthMapFrame& frame) {
        DepthMap map;
        map.format = frame.format;
        map.compare = frame.compare;
        map.decode = frame.decode;
        map.width = frame.width;
        map.height = frame.height;
        map.texels.resize(map.texelBytes());
        const auto target = DepthMapTarget::create(frame);
        EXPECT_TRUE(target) << target.error().message;
        const auto done = renderer_->render(mesh, frame, *target);
        EXPECT_TRUE(done) << done.error().message;
        EXPECT_TRUE(target->read(0, 0, target->width(), target->height(), map.texels));
        return map;
    }

    std::optional<DepthMapRenderer> renderer_;
};

/// The bytes that the CPU writes for a texel.
std::vector<std::byte> encoded(MapFormat format, const std::optional<Surface>& front,
                               const std::optional<Surface>& back) {
    std::vector<std::byte> bytes(texelSize(format));
    encodeTexel(format, {front, back}, bytes);
    return bytes;
}

/// x of the centre of a texel in [−1, 1].
double centre(std::uint32_t i, std::uint32_t size) {
    return -1.0 + (i + 0.5) * 2.0 / size;
}

/// The same bytes; of floats, which GPUs round as they like, within two units in the last place.
bool sameTexel(MapFormat format, std::span<const std::byte> want, std::span<const std::byte> got) {
    if (format != MapFormat::kFloat32) {
        return std::equal(want.begin(), want.end(), got.begin());
    }
    std::array<float, 4> a{};
    std::array<float, 4> b{};
    std::memcpy(a.data(), want.data(), sizeof(a));
    std::memcpy(b.data(), got.data(), sizeof(b));
    return std::equal(a.begin(), a.end(), b.begin(),
                      [](float x, float y) { return std::abs(x - y) <= 2.4e-7F * std::abs(x); });
}

TEST_P(DepthMapRendererGlTest, APlaneIsWrittenToTheBit) {
    constexpr std::uint32_t kSize = 16;
    constexpr float kZ = 0.25F;
    // Half of the image: edges between texels' centres, so that coverage is beyond doubt.
    GpuMesh mesh = upload(sheet({-0.5F, -0.25F}, {0.5F, 0.75F}, 3, [](float, float) { return kZ; }));
    for (const MapFormat format : kOrthographic) {
        for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
            for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
                SCOPED_TRACE(std::string(mapFormatName(format)) + " " + compareName(compare) + " " +
                             decodeName(decode));
                const DepthMapFrame frame = alongZ(format, compare, kSize, decode);
                const DepthMap map = render(mesh, frame);
                // 0.625 is between two codes, 40958 and 40959: planes move towards their viewer.
                const bool plane = decode == Decode::kPlane;
                const double near_depth = plane ? 40958.0 / 65534.0 : 0.625;
                double far_depth = plane ? 40959.0 / 65534.0 : 0.625;
                double front_depth = near_depth;
                if (plane && format == MapFormat::kFrontBackHalf) {  // halves are 2^-11 apart here
                    front_depth = 0.625 - std::ldexp(1.0, -11);
                    far_depth = 0.625 + std::ldexp(1.0, -11);
                }
                const Surface front{static_cast<float>(front_depth), {0.0F, 0.0F, -1.0F}};
                const Surface back{static_cast<float>(far_depth), {0.0F, 0.0F, 1.0F}};
                for (std::uint32_t y = 0; y < kSize; ++y) {
                    for (std::uint32_t x = 0; x < kSize; ++x) {
                        const bool covered =
                            std::abs(centre(x, kSize)) < 0.5 && std::abs(centre(y, kSize) - 0.25) < 0.5;
                        std::vector<std::byte> want = encoded(format, std::nullopt, std::nullopt);
                        if (covered && isFrontBack(format)) {
                            want = encoded(format, front, back);
                        } else if (covered) {
                            want = encoded(format, compare == Compare::kLess ? front : back, std::nullopt);
                        }
                        const auto got = map.texelAt(0, x, y);
                        ASSERT_TRUE(sameTexel(format, want, got)) << x << " " << y;
                    }
                }
            }
        }
    }
}

TEST_P(DepthMapRendererGlTest, TiltedPlanesHaveTheirDepthAndNormal) {
    constexpr std::uint32_t kSize = 128;
    for (const glm::dvec2& slope : {glm::dvec2(0.3, -0.2), glm::dvec2(-0.7, 0.2), glm::dvec2(0.0, 0.9)}) {
        const auto height = [&](double x, double y) { return slope.x * x + slope.y * y + 0.03; };
        GpuMesh mesh = upload(sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 17, [&](float x, float y) {
            return static_cast<float>(height(double{x}, double{y}));
        }));
        const glm::vec3 up = glm::vec3(glm::normalize(glm::dvec3(-slope.x, -slope.y, 1.0)));
        for (const MapFormat format : kOrthographic) {
            const DepthMap map = render(mesh, alongZ(format, Compare::kLess, kSize));
            for (std::uint32_t y = 0; y < kSize; ++y) {
                for (std::uint32_t x = 0; x < kSize; ++x) {
                    const double depth = 0.5 * (height(centre(x, kSize), centre(y, kSize)) + 1.0);
                    const Texel texel = decodeTexel(format, map.texelAt(0, x, y));
                    ASSERT_TRUE(texel.front) << x << " " << y;
                    // Half a step of the code, and what the corners' floats are rounded by.
                    const double step = format == MapFormat::kFrontBackHalf ? std::ldexp(1.0, -12)
                                        : format == MapFormat::kFloat32     ? 0.0
                                                                            : 0.5 / 65534.0;
                    ASSERT_NEAR(texel.front->depth, depth, step + 1e-6) << x << " " << y;
                    const NormalIndex index = encodeNormal(-up);
                    if (format == MapFormat::kFloat32) {
                        ASSERT_GT(glm::dot(texel.front->normal, -up), 1.0F - 1e-6F);
                    } else {
                        ASSERT_EQ(encodeNormal(texel.front->normal), index) << x << " " << y;
                    }
                    if (isFrontBack(format)) {
                        ASSERT_TRUE(texel.back);
                        ASSERT_NEAR(texel.back->depth, depth, step + 1e-6);
                        ASSERT_EQ(encodeNormal(texel.back->normal), encodeNormal(up));
                    }
                }
            }
        }
    }
}

TEST_P(DepthMapRendererGlTest, BoxesRoundACubeMapHaveEveryTexel) {
    constexpr std::uint32_t kSize = 32;
    // One in the other: LESS keeps the inner one, GREATER the outer one.
    Mesh both = box({0.25F, 0.5F, 0.375F});
    const Mesh outer = box({0.75F, 0.625F, 0.875F});
    for (const glm::uvec3& t : outer.triangles) {
        both.triangles.push_back(t + 8U);
    }
    both.positions.insert(both.positions.end(), outer.positions.begin(), outer.positions.end());
    GpuMesh mesh = upload(both);
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        const bool less = compare == Compare::kLess;
        const glm::dvec3 half = less ? glm::dvec3(0.25, 0.5, 0.375) : glm::dvec3(0.75, 0.625, 0.875);
        DepthMapFrame frame = alongZ(MapFormat::kCube8, compare, kSize);
        const DepthMap map = render(mesh, frame);
        for (std::uint32_t face = 0; face < 6; ++face) {
            for (std::uint32_t y = 0; y < kSize; ++y) {
                for (std::uint32_t x = 0; x < kSize; ++x) {
                    const glm::dvec3 d =
                        glm::normalize(glm::dvec3(cubeDirection({face, (static_cast<float>(x) + 0.5F) / kSize,
                                                                 (static_cast<float>(y) + 0.5F) / kSize})));
                    double depth = 10.0;
                    int axis = 0;
                    for (int k = 0; k < 3; ++k) {
                        if (half[k] / std::abs(d[k]) < depth) {
                            depth = half[k] / std::abs(d[k]);
                            axis = k;
                        }
                    }
                    glm::vec3 normal(0.0F);
                    normal[axis] = (d[axis] > 0.0) == less ? -1.0F : 1.0F;
                    const auto got = map.texelAt(face, x, y);
                    const Texel texel = decodeTexel(MapFormat::kCube8, got);
                    ASSERT_TRUE(texel.front) << face << " " << x << " " << y;
                    ASSERT_NEAR(texel.front->depth, depth, 0.51 * double{kCubeDepthMax} / 65534.0)
                        << face << " " << x << " " << y;
                    ASSERT_EQ(texel.front->normal, normal) << face << " " << x << " " << y;
                }
            }
        }
    }
}

TEST_P(DepthMapRendererGlTest, NothingIsTooNearToACubesCentre) {
    constexpr std::uint32_t kSize = 8;
    for (const float near : {1e-4F, 1e-7F}) {
        GpuMesh mesh = upload(sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 5, [near](float, float) { return near; }));
        DepthMapFrame frame = alongZ(MapFormat::kCube8, Compare::kLess, kSize);
        const DepthMap map = render(mesh, frame);
        for (std::uint32_t y = 0; y < kSize; ++y) {
            for (std::uint32_t x = 0; x < kSize; ++x) {
                const Texel texel = decodeTexel(MapFormat::kCube8, map.texelAt(4, x, y));
                ASSERT_TRUE(texel.front) << near << " " << x << " " << y;
                const double slant =
                    std::sqrt(1.0 + std::pow(centre(x, kSize), 2) + std::pow(centre(y, kSize), 2));
                ASSERT_NEAR(texel.front->depth, slant * double{near}, 0.51 * double{kCubeDepthMax} / 65534.0);
                ASSERT_FALSE(decodeTexel(MapFormat::kCube8, map.texelAt(5, x, y)).front) << "behind";
            }
        }
    }
}

TEST_P(DepthMapRendererGlTest, StandingAndFacingPlanesKeepTheirWord) {
    // One steep sheet, seen at every cosine from 0.5 down to 0.002: what is stored says 0 at the surface
    // point.
    constexpr std::uint32_t kSize = 64;
    int stood = 0;
    for (const double slope : {1.7, 10.0, 25.0, 31.0, 33.0, 60.0, 200.0}) {
        const double width = 0.9 / slope;
        GpuMesh mesh = upload(sheet({static_cast<float>(-width), -1.0F}, {static_cast<float>(width), 1.0F}, 2,
                                    [&](float x, float) { return static_cast<float>(slope * double{x}); }));
        for (const MapFormat format : {MapFormat::kFixed8, MapFormat::kFloat32, MapFormat::kFrontBackHalf}) {
            DepthMapFrame frame = alongZ(format, Compare::kLess, kSize, Decode::kPlane);
            // Eight times finer to the right, so that the sheet has texels.
            frame.axis[0].x = 0.25;
            frame.origin.x = -0.125;
            DepthMap map = render(mesh, frame);
            map.object_to_map.row[0] = {4.0F, 0.0F, 0.0F, 0.5F};
            map.object_to_map.row[1] = {0.0F, 0.5F, 0.0F, 0.5F};
            map.object_to_map.row[2] = {0.0F, 0.0F, 0.5F, 0.5F};
            map.object_per_map = {0.25F, 2.0F, 2.0F};
            int covered = 0;
            for (std::uint32_t y = 1; y + 1 < kSize; ++y) {
                for (std::uint32_t x = 1; x + 1 < kSize; ++x) {
                    const double at = -0.125 + 0.25 * (x + 0.5) / kSize;
                    const glm::vec3 on(static_cast<float>(at), static_cast<float>(centre(y, kSize)),
                                       static_cast<float>(slope * at));
                    const Texel texel = decodeTexel(format, map.texelAt(0, x, y));
                    ASSERT_EQ(texel.front.has_value(), std::abs(at) < width) << slope << " " << x << " " << y;
                    if (!texel.front) {
                        continue;
                    }
                    ++covered;
                    const auto said = vote(map, on);
                    ASSERT_TRUE(said);
                    // A step of the code, along the normal at most.
                    const float step = format == MapFormat::kFrontBackHalf ? 2e-3F : 1e-4F;
                    ASSERT_NEAR(said->distance, 0.0F, step) << slope << " " << x << " " << y;
                    const float cosine = std::abs(texel.front->normal.z);
                    ASSERT_GT(std::abs(cosine - kStandingCosine), 0.9e-4F)
                        << "a reader could take it for the other";
                    stood += cosine < kStandingCosine ? 1 : 0;
                }
            }
            EXPECT_GT(covered, 0) << slope;
            // The border is empty.
            for (std::uint32_t i = 0; i < kSize; ++i) {
                EXPECT_FALSE(decodeTexel(format, map.texelAt(0, i, 0)).front);
                EXPECT_FALSE(decodeTexel(format, map.texelAt(0, i, kSize - 1)).front);
                EXPECT_FALSE(decodeTexel(format, map.texelAt(0, 0, i)).front);
                EXPECT_FALSE(decodeTexel(format, map.texelAt(0, kSize - 1, i)).front);
            }
        }
    }
    EXPECT_GT(stood, 100);
}

TEST_P(DepthMapRendererGlTest, RaysThatStartInsideLeaveTexelsEmpty) {
    GpuMesh mesh = upload(sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 1, [](float, float) { return 0.25F; }));
    DepthMapFrame frame = alongZ(MapFormat::kFixed8, Compare::kLess, 8);
    // The view sees the inner side.
    for (const bool free : {true, false}) {
        frame.starts_free[0] = free;
        const DepthMap map = render(mesh, frame);
        EXPECT_EQ(decodeTexel(map.format, map.texelAt(0, 3, 4)).front.has_value(), free);
    }
}

TEST_P(DepthMapRendererGlTest, ScaleDoesNotMatter) {
    // Powers of two, so that nothing rounds another way.
    std::vector<std::byte> first;
    for (const int power : {0, -40, 45}) {
        Mesh scaled = sheet({-1.0F, -1.0F}, {1.0F, 1.0F}, 9, [](float x, float y) { return 0.5F * x * y; });
        for (glm::vec3& p : scaled.positions) {
            p *= std::ldexp(1.0F, power);
        }
        DepthMapFrame frame = alongZ(MapFormat::kFrontBackFixed, Compare::kBoth, 32, Decode::kPlane);
        frame.origin *= std::ldexp(1.0, power);
        for (glm::dvec3& axis : frame.axis) {
            axis *= std::ldexp(1.0, power);
        }
        GpuMesh mesh = upload(scaled);
        const DepthMap map = render(mesh, frame);
        first = first.empty() ? map.texels : first;
        EXPECT_TRUE(map.texels == first) << power;
    }
}

TEST_P(DepthMapRendererGlTest, VerticesMoveAndTheSurfacesMotionIsKnown) {
    const Mesh before = box({0.5F, 0.5F, 0.5F});
    Mesh after = before;
    const glm::vec3 way(0.125F, -0.0625F, 0.25F);
    for (glm::vec3& p : after.positions) {
        p += way;
    }
    const DepthMapFrame frame = alongZ(MapFormat::kFrontBackFixed, Compare::kBoth, 16);
    GpuMesh moved = upload(before, {.keep_previous = true});
    GpuMesh made = upload(after);
    const std::uint64_t revision = moved.revision();
    EXPECT_FALSE(render(moved, frame).texels == render(made, frame).texels);
    // From a buffer of the GPU, behind other things in it.
    const GlBuffer buffer = makeBuffer();
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    const std::size_t bytes = after.positions.size() * sizeof(glm::vec3);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes + 8), nullptr, GL_STATIC_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 8, static_cast<GLsizeiptr>(bytes), after.positions.data());
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    ASSERT_TRUE(moved.setPositions(buffer.name(), 8));
    EXPECT_NE(moved.revision(), revision);
    EXPECT_TRUE(render(moved, frame).texels == render(made, frame).texels);

    const auto target = DepthMapTarget::create(frame, true);
    ASSERT_TRUE(target) << target.error().message;
    for (const bool settled : {false, true}) {
        if (settled) {
            moved.settle();
        }
        ASSERT_TRUE(renderer_->render(moved, frame, *target));
        const glm::vec3 want = settled ? glm::vec3(0.0F) : way;
        std::vector<float> motion[2];
        for (int i = 0; i < 2; ++i) {
            motion[i].resize(std::size_t{16} * 16 * 4);
            glBindFramebuffer(GL_READ_FRAMEBUFFER, target->framebuffer());
            glReadBuffer(GL_COLOR_ATTACHMENT1 + static_cast<GLenum>(i));
            glReadPixels(0, 0, 16, 16, GL_RGBA, GL_FLOAT, motion[i].data());
        }
        glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
        std::vector<std::byte> texels(std::size_t{16} * 16 * 8);
        ASSERT_TRUE(target->read(0, 0, 16, 16, texels));
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
    // A fan: one vertex of all triangles; and triangles without any vertex of their own.
    Mesh fan;
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
    // Each texel has the normal of a triangle that holds its centre, or comes within 1/100 texel of it.
    const DepthMapFrame frame = alongZ(MapFormat::kFloat32, Compare::kLess, 63);
    const DepthMap map = render(mesh, frame);
    int covered = 0;
    for (std::uint32_t i = 0; i < 63 * 63; ++i) {
        const Texel texel = decodeTexel(frame.format, map.texelAt(0, i % 63, i / 63));
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
                   glm::length(n - turn * glm::sign(texel.front->normal.z) * texel.front->normal) < 1e-5F;
        });
        EXPECT_TRUE(found) << i;
    }
    EXPECT_GT(covered, 1500);
}

TEST_P(DepthMapRendererGlTest, WhatIsWrongIsRefused) {
    const Mesh good = box({0.5F, 0.5F, 0.5F});
    Mesh bad = good;
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
    EXPECT_EQ(mesh.setPositions(GLuint{0}).error().code, ErrorCode::kUsage);
    EXPECT_EQ(mesh.setPositions(GLuint{12345}).error().code, ErrorCode::kUsage);
    glBindBuffer(GL_ARRAY_BUFFER, buffer.name());
    glBufferData(GL_ARRAY_BUFFER, 96, nullptr, GL_STATIC_DRAW);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    EXPECT_EQ(mesh.setPositions(buffer.name(), 4).error().code, ErrorCode::kUsage);
    EXPECT_EQ(mesh.setPositions(buffer.name(), 2).error().code, ErrorCode::kUsage);
    EXPECT_EQ(mesh.setPositions(buffer.name(), std::numeric_limits<std::size_t>::max() - 3).error().code,
              ErrorCode::kUsage);

    const DepthMapFrame frame = alongZ(MapFormat::kFixed8, Compare::kLess, 16);
    const auto target = DepthMapTarget::create(frame);
    ASSERT_TRUE(target);
    const auto refused = [&](const std::function<void(DepthMapFrame&)>& spoil) {
        DepthMapFrame spoilt = frame;
        spoil(spoilt);
        const auto done = renderer_->render(mesh, spoilt, *target);
        return !done && done.error().code == ErrorCode::kUsage;
    };
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.width = 2; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.height = kMapSizeMax + 1; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.width = 17; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.compare = Compare::kBoth; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) {
        f.format = MapFormat::kFrontBackFixed;
        f.compare = Compare::kGap;
    }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.format = MapFormat::kFrontBackHalf; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.format = MapFormat::kFloat32; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.axis[1] = glm::dvec3(0.0); }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.axis[2].z = 1e300; }));
    EXPECT_TRUE(refused([](DepthMapFrame& f) { f.origin.x = std::numeric_limits<double>::quiet_NaN(); }));
    std::vector<std::byte> room(4);
    EXPECT_EQ(target->read(16, 0, 1, 1, room).error().code, ErrorCode::kUsage);
    EXPECT_EQ(target->read(0, 0, 2, 1, room).error().code, ErrorCode::kUsage);
    DepthMapFrame huge = frame;
    huge.width = 0;
    EXPECT_EQ(DepthMapTarget::create(huge).error().code, ErrorCode::kUsage);
    huge.format = MapFormat::kCube8;
    huge.width = huge.height = kMapSizeMax;
    EXPECT_EQ(DepthMapTarget::create(huge).error().code, ErrorCode::kLimit);
}

TEST_P(DepthMapRendererGlTest, AMapsOwnFrameIsFound) {
    DepthMap map;
    map.width = 24;
    map.height = 16;
    // Turned about y, scaled, shifted: x' = (z + 3)/4, y' = (y + 1)/2, z' = (2 - x)/8.
    map.object_to_map.row[0] = {0.0F, 0.0F, 0.25F, 0.75F};
    map.object_to_map.row[1] = {0.0F, 0.5F, 0.0F, 0.5F};
    map.object_to_map.row[2] = {-0.125F, 0.0F, 0.0F, 0.25F};
    const DepthMapFrame frame = frameOf(map);
    EXPECT_LT(glm::length(frame.origin - glm::dvec3(2.0, -1.0, -3.0)), 1e-12);
    EXPECT_LT(glm::length(frame.axis[0] - glm::dvec3(0.0, 0.0, 4.0)), 1e-12);
    EXPECT_LT(glm::length(frame.axis[1] - glm::dvec3(0.0, 2.0, 0.0)), 1e-12);
    EXPECT_LT(glm::length(frame.axis[2] - glm::dvec3(-8.0, 0.0, 0.0)), 1e-12);
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(DepthMapRendererGlTest);

}  // namespace relief
