// SPDX-License-Identifier: Apache-2.0
// Baked maps of a box, a torus and a plane compared with closed forms, for every format, direction and compare. Detects
// wrong signs, scales, axes, faces, borders and rounding, and inward normals.
#include <cmath>
#include <glm/geometric.hpp>

#include "bake/mesh/mesh_query.h"
#include "formats/plane.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

/// Half a quantization step at `depth`, plus float errors of the transform and the ray.
double depthTolerance(MapFormat format, double depth) {
    constexpr double kFloats = 5e-7;
    switch (format) {
        case MapFormat::kFloat32:
            return kFloats;
        case MapFormat::kFixed8:
        case MapFormat::kFrontBackFixed:
            return 0.5 / 65534.0 + kFloats;
        case MapFormat::kCube8:
            return 0.5 * 1.7320509 / 65534.0 + kFloats;
        case MapFormat::kFrontBackHalf:
            return std::ldexp(depth, -11) + kFloats;  // at most half a unit in the last of 11 bits
        case MapFormat::kPatches:
            break;
    }
    return 0.0;
}

const glm::dvec3 kBoxCenter(0.3125, -0.25, 0.5);
const glm::dvec3 kBoxHalf(1.0, 0.5, 0.75);

/// The interval of a ray inside a box centred at the origin.
struct Span {
    double in = -1e300;
    double out = 1e300;
    glm::dvec3 normal_in{0.0};
    glm::dvec3 normal_out{0.0};
    [[nodiscard]] bool hit() const { return in < out; }
};

Span slabs(const glm::dvec3& origin, const glm::dvec3& direction, const glm::dvec3& half) {
    Span span;
    for (int i = 0; i < 3; ++i) {
        if (direction[i] == 0.0) {
            span.in = std::abs(origin[i]) > half[i] ? 1e300 : span.in;
            continue;
        }
        glm::dvec3 normal(0.0);
        normal[i] = direction[i] > 0.0 ? 1.0 : -1.0;
        const double middle = -origin[i] / direction[i];
        const double reach = half[i] / std::abs(direction[i]);
        if (middle - reach > span.in) {
            span.in = middle - reach;
            span.normal_in = -normal;
        }
        if (middle + reach < span.out) {
            span.out = middle + reach;
            span.normal_out = normal;
        }
    }
    return span;
}

void expectSurface(const std::optional<Surface>& surface, double depth, const glm::dvec3& normal,
                   const DepthMap& map, double depth_slack = 0.0) {
    ASSERT_TRUE(surface);
    EXPECT_NEAR(surface->depth, depth, depthTolerance(map.format, depth) + depth_slack);
    // Quantized normals have errors up to 0.64°.
    const double cosine = glm::dot(glm::dvec3(surface->normal), normal);
    EXPECT_GT(cosine, map.format == MapFormat::kFloat32 ? 1.0 - 1e-6 : std::cos(0.65 * 0.0174533));
}

/// Checks every texel of a map of the box. In the box's frame the slab test gives the truth.
void checkBoxMap(const DepthMap& map, const glm::dmat3& axes = glm::dmat3(1.0)) {
    const glm::dmat3 inverse = glm::transpose(axes);
    const bool turned = axes != glm::dmat3(1.0);
    const double slack = turned ? 2e-6 : 0.0;  // float errors of the transform on sloped faces
    int hits = 0;
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 0; y < map.height; ++y) {
            for (std::uint32_t x = 0; x < map.width; ++x) {
                SCOPED_TRACE(std::to_string(face) + ": " + std::to_string(x) + ", " + std::to_string(y));
                const Texel texel = decodeTexel(map.format, map.texelAt(face, x, y));
                const TexelRay ray = texelRay(map, face, x, y);
                const Span span =
                    slabs(inverse * (ray.origin - kBoxCenter), inverse * ray.direction, kBoxHalf);
                if (std::abs(span.out - span.in) < (turned ? 1e-4 : 1e-5)) {
                    continue;  // along an edge
                }
                if (!span.hit() || span.out < 0.0) {
                    ASSERT_FALSE(texel.front || texel.back);
                    continue;
                }
                ++hits;
                const auto expectEnd = [&](const std::optional<Surface>& surface, bool out) {
                    expectSurface(surface, out ? span.out : span.in,
                                  axes * (out ? span.normal_out : span.normal_in), map, slack);
                };
                expectEnd(texel.front, map.compare == Compare::kGreater);
                if (map.compare == Compare::kBoth) {
                    expectEnd(texel.back, true);
                }
                if (testing::Test::HasFailure()) {
                    return;  // one failing texel is enough
                }
            }
        }
    }
    EXPECT_GT(hits, turned ? 1000 : 20);
}

TEST(BakeBox, OrthographicMapsAreExact) {
    const TriangleMesh mesh = makeBoxMesh(kBoxCenter, kBoxHalf);
    for (const std::string direction : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
        for (const std::string head :
             {"float:compare=less,dir=", "float:compare=greater,dir=", "fixed8:compare=less,dir=",
              "fixed8:compare=greater,dir=", "front-back:dir="}) {
            SCOPED_TRACE(head + direction);
            const DepthMap map = bakeMap(mesh, head + direction + ",size=37x24");
            checkBoxMap(map);
            EXPECT_TRUE(map.encloses);
            EXPECT_TRUE(map.empty_is_outside);
        }
    }
}

TEST(BakeBox, CubesAreExact) {
    const TriangleMesh mesh = makeBoxMesh(kBoxCenter, kBoxHalf);
    // The middle, another point inside, and a point outside that views the box.
    for (const std::string spec :
         {"cube:size=24", "cube:size=24,center=1/-0.5/0.25", "cube:size=33,center=-2/1/1"}) {
        SCOPED_TRACE(spec);
        const DepthMap map = bakeMap(mesh, spec);
        EXPECT_EQ(map.compare, spec == "cube:size=33,center=-2/1/1" ? Compare::kLess : Compare::kGreater);
        checkBoxMap(map);
    }
    // GREATER from outside keeps the far side.
    checkBoxMap(bakeMap(mesh, "cube:size=33,center=-2/1/1,compare=greater"));
}

TEST(BakeBox, TiltedBoxAlongAnObliqueDirection) {
    const glm::dmat3 axes = rotation({-1, 0.3, 2}, 71.0);
    const DepthMap map =
        bakeMap(makeBoxMesh(kBoxCenter, kBoxHalf, axes), "front-back:dir=1/-2/0.7,size=80x50");
    EXPECT_TRUE(map.encloses);
    checkBoxMap(map, axes);
}

TEST(BakeBox, RaysAlongEdgesHitAFrontFace) {
    // Texel centres of column 2 are exactly on the edge x = 0, so rays hit both faces there.
    const TriangleMesh roof =
        finished({{-1, 0, -1}, {0, 1, -1}, {1, 0, -1}, {-1, 0, 1}, {0, 1, 1}, {1, 0, 1}},
                 {{0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {0, 2, 5}, {0, 5, 3}, {0, 1, 2}, {3, 5, 4}});
    for (const std::string resolution : {"5x5", "7x9"}) {
        const DepthMap map = bakeMap(roof, "float:dir=-y,box=-1.5/-0.5/-1.5/1.5/1.5/1.5,size=" + resolution);
        const Texel ridge = decodeTexel(map.format, map.texelAt(0, map.width / 2, map.height / 2));
        ASSERT_TRUE(ridge.front);
        EXPECT_NEAR(ridge.front->depth, 0.25, 1e-6);
        // The left face has the lower triangle index.
        EXPECT_NEAR(ridge.front->normal.x, -std::sqrt(0.5), 1e-6);
        EXPECT_NEAR(ridge.front->normal.y, std::sqrt(0.5), 1e-6);
    }
}

TEST(BakeTorus, AutomaticCompareDependsOnTheCubeCenter) {
    const TriangleMesh mesh = makeTorusMesh(1.0, 0.25, 96, 48);
    const DepthMap hole = bakeMap(mesh, "cube:size=65");
    EXPECT_EQ(hole.compare, Compare::kLess);
    EXPECT_TRUE(hole.empty_is_outside);
    EXPECT_EQ(vote(hole, {0, 0, 0.1F})->distance, kFarOutside);
    EXPECT_NEAR(vote(hole, {0.5F, 0, 0})->distance, 0.25, 2e-3);
    EXPECT_LT(vote(hole, {0.9F, 0, 0})->distance, 0.0F);
    EXPECT_EQ(bakeMap(mesh, "cube:size=65,center=1/0/0").compare, Compare::kGreater);
}

TEST(BakePlane, FlatMeshFacesTheViewer) {
    for (const TriangleMesh& mesh : {makePlane(0.25F, 4), reversed(makePlane(0.25F, 4))}) {
        for (const std::string direction : {"-y", "+y"}) {
            const DepthMap map = bakeMap(mesh, "float:dir=" + direction);
            for (std::uint32_t y = 1; y + 1 < map.height; ++y) {
                for (std::uint32_t x = 1; x + 1 < map.width; ++x) {
                    const Texel texel = decodeTexel(map.format, map.texelAt(0, x, y));
                    ASSERT_TRUE(texel.front);
                    ASSERT_NEAR(texel.front->depth, 0.5, 1e-5);
                    ASSERT_EQ(texel.front->normal, glm::vec3(0, direction == "-y" ? 1 : -1, 0));
                }
            }
            // Distances above the plane are exact in the view from above.
            if (direction == "-y") {
                EXPECT_NEAR(vote(map, {0.1F, 1.25F, -0.3F}).value().distance, 1.0F, 1e-5);
                EXPECT_LT(vote(map, {0.1F, 0.245F, -0.3F})->distance, 0.0F);
            }
        }
    }
}

TEST(BakeWinding, InvertedMeshesGiveTheSameMaps) {
    const std::vector<std::string> specs = {"float:dir=+x",
                                            "fixed8:dir=1/2/3,compare=greater",
                                            "front-back:dir=-y",
                                            "cube",
                                            "cube:center=3/0/0",
                                            "float:dir=-z,box=-0.5/-0.5/-0.5/2/2/0.25",
                                            "front-back:dir=+x,box=0/-1/-1/0.5/1/1"};
    for (const TriangleMesh& mesh :
         {makeIcosphere({0.1, 0.2, 0.3}, 0.8, 3), makeTorusMesh(1.0, 0.3, 40, 20)}) {
        const Collider ours = bakeSpecs(mesh, specs);
        const Collider other = bakeSpecs(reversed(mesh), specs);
        for (std::size_t i = 0; i < specs.size(); ++i) {
            const DepthMap& a = ours.maps[i];
            const DepthMap& b = other.maps[i];
            EXPECT_EQ(a.object_to_map, b.object_to_map);
            for (std::uint32_t k = 0; k < a.faceCount() * a.width * a.height; ++k) {
                const std::uint32_t face = k / (a.width * a.height);
                const std::uint32_t y = k / a.width % a.height;
                const Texel ta = decodeTexel(a.format, a.texelAt(face, k % a.width, y));
                const Texel tb = decodeTexel(b.format, b.texelAt(face, k % a.width, y));
                ASSERT_EQ(ta.front.has_value(), tb.front.has_value()) << specs[i];
                ASSERT_EQ(ta.back.has_value(), tb.back.has_value()) << specs[i];
                if (ta.front) {
                    ASSERT_NEAR(ta.front->depth, tb.front->depth, 2.0 * depthTolerance(a.format, 1.0));
                    ASSERT_GT(glm::dot(ta.front->normal, tb.front->normal), 0.999F) << specs[i];
                }
            }
        }
    }
}

TEST(BakeSubBox, VolumesThatCutTheObjectAbstain) {
    const TriangleMesh mesh = makeBoxMesh({0, 0, 0}, {1, 1, 1});

    // A window beside the middle, at full depth: rays start in free space.
    const DepthMap window = bakeMap(mesh, "fixed8:dir=-y,box=-0.5/-2/-0.5/0.5/2/0.5");
    EXPECT_FALSE(window.encloses);
    EXPECT_TRUE(window.empty_is_outside);
    EXPECT_FALSE(vote(window, {0.75F, 1.5F, 0})) << "must abstain outside the volume";
    EXPECT_NEAR(vote(window, {0.25F, 1.5F, 0})->distance, 0.5F, 1e-3);
    EXPECT_NEAR(vote(window, {0.25F, 0.5F, 0})->distance, -0.5F, 1e-3);

    // A near plane inside the object: texels that would show the inner side of the solid stay empty and abstain.
    const DepthMap cut = bakeMap(mesh, "float:dir=-y,box=-2/-2/-2/2/0.5/2");
    EXPECT_FALSE(cut.encloses);
    EXPECT_FALSE(cut.empty_is_outside);
    EXPECT_FALSE(decodeTexel(cut.format, cut.texelAt(0, 32, 32)).front);
    EXPECT_FALSE(vote(cut, {0, 0, 0}));

    // The opposite end sees free space: its surface is kept, and empty rays are outside.
    const DepthMap half = bakeMap(mesh, "front-back:dir=-y,box=-2/-2/-2/2/0.5/2");
    EXPECT_TRUE(half.empty_is_outside);
    const Texel middle = decodeTexel(half.format, half.texelAt(0, 32, 32));
    EXPECT_FALSE(middle.front);
    ASSERT_TRUE(middle.back);
    EXPECT_EQ(middle.back->normal, glm::vec3(0, -1, 0));
    EXPECT_LT(vote(half, {0, 0, 0})->distance, 0.0F);
    EXPECT_EQ(vote(half, {1.5F, 0, 0})->distance, kFarOutside);

    // A far plane inside the object does not affect LESS.
    const DepthMap top = bakeMap(mesh, "fixed8:dir=-y,box=-2/0.5/-2/2/2/2");
    EXPECT_TRUE(top.empty_is_outside);
    EXPECT_NEAR(vote(top, {0, 1.5F, 0})->distance, 0.5F, 1e-3);

    // If the volume equals the mesh bounds, surfaces on the volume's faces are still hit.
    const DepthMap exact = bakeMap(mesh, "float:dir=-y,box=-1/-1/-1/1/1/1");
    EXPECT_TRUE(exact.encloses);
    EXPECT_TRUE(exact.empty_is_outside);
    for (const std::uint32_t at : {1U, 20U, 62U}) {
        const Texel texel = decodeTexel(exact.format, exact.texelAt(0, at, 63 - at));
        ASSERT_TRUE(texel.front);
        EXPECT_NEAR(texel.front->depth, 0.0F, 1e-6);
    }

    // Cubes: LESS in free space is always sound; GREATER only if the cube contains the object.
    EXPECT_TRUE(bakeMap(mesh, "cube:box=0.9/0.9/0.9/2/2/2,compare=less").empty_is_outside);
    EXPECT_FALSE(bakeMap(mesh, "cube:box=0.5/0.5/0.5/2/2/2,compare=greater").empty_is_outside);
    EXPECT_FALSE(bakeMap(mesh, "cube:box=0.5/0.5/0.5/2/2/2,compare=greater").encloses);
    EXPECT_TRUE(bakeMap(mesh, "cube").encloses);
}

TEST(BakeScale, TinyHugeAndFarMeshesBake) {
    for (const double scale : {1e-12, 1e-3, 1e4, 1e14}) {
        SCOPED_TRACE(scale);
        const TriangleMesh mesh = makeBoxMesh(kBoxCenter * scale, kBoxHalf * scale);
        for (const std::string spec : {"float:dir=-x", "front-back:dir=1/1/1", "cube"}) {
            const DepthMap map = bakeMap(mesh, spec);
            EXPECT_LT(vote(map, kBoxCenter * scale).value().distance, -0.2 * scale);
            EXPECT_GT(vote(map, (kBoxCenter + 3.0 * kBoxHalf) * scale).value().distance, 0.0);
        }
    }
    // At 1000 times its size from the origin, floats still separate the faces.
    const DepthMap map = bakeMap(makeBoxMesh({1000, -2000, 500}, kBoxHalf), "float:dir=-x");
    EXPECT_TRUE(map.encloses);
    EXPECT_NEAR(vote(map, {1000, -2000, 500})->distance, -1.0, 2e-3);
}

TEST(BakeErrors, HaveTheRightCodes) {
    const TriangleMesh mesh = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    const auto code = [&](const std::vector<MapSpec>& specs, std::uint32_t resolution) {
        BakeOptions options;
        options.maps = specs;
        options.resolution = resolution;
        return bake(mesh, options).error().code;
    };
    EXPECT_EQ(code({}, 0), ErrorCode::kUsage);
    EXPECT_EQ(code({}, 16385), ErrorCode::kLimit);
    EXPECT_EQ(code(std::vector<MapSpec>(1025), 8), ErrorCode::kLimit);
    EXPECT_EQ(code({}, 16384), ErrorCode::kLimit) << "the texels would need 2 GiB";
    EXPECT_EQ(code({*parseMapSpec("float:box=5/5/5/6/6/6")}, 8), ErrorCode::kFailure);
}

TEST(BakeReportTest, WarnsOfProbableUserErrors) {
    BakeOptions options;
    options.resolution = 8;
    for (const char* spec : {"float", "cube:compare=less", "float:box=5/5/5/6/6/6"}) {
        options.maps.push_back(*parseMapSpec(spec));
    }
    const BakeReport report = required(bake(makeBoxMesh({0, 0, 0}, {1, 1, 1}), options)).report;
    ASSERT_EQ(report.warnings.size(), 2U);
    EXPECT_NE(report.warnings[0].find("map 1"), std::string::npos);
    EXPECT_NE(report.warnings[1].find("map 2"), std::string::npos);
    EXPECT_EQ(report.maps[0].covered, 36U);
    EXPECT_EQ(report.maps[0].texels, 64U);
}

}  // namespace
}  // namespace relief::test
