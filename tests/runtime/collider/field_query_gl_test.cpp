// SPDX-License-Identifier: Apache-2.0
// shaders/collider/collider.glsl against formats/collider.cpp, point by point. Maps are random bytes in random frames:
// the two must agree on any texture content, not only on output of the baker.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <span>

#include "runtime/bodies/world_textures.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/collider/field_agreement.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/seeds.h"

namespace relief {
namespace {

struct Kind {
    MapFormat format;
    Compare compare;
    std::uint32_t width;
    std::uint32_t height;
};
constexpr Kind kKinds[] = {
    {MapFormat::kFloat32, Compare::kLess, 32, 48},       {MapFormat::kFloat32, Compare::kGreater, 17, 9},
    {MapFormat::kFixed8, Compare::kLess, 64, 64},        {MapFormat::kFixed8, Compare::kGreater, 5, 90},
    {MapFormat::kFrontBackHalf, Compare::kBoth, 33, 40}, {MapFormat::kCube8, Compare::kLess, 31, 31},
    {MapFormat::kCube8, Compare::kGreater, 40, 40},      {MapFormat::kFrontBackFixed, Compare::kBoth, 40, 33},
    {MapFormat::kFrontBackHalf, Compare::kBoth, 35, 30}, {MapFormat::kFrontBackFixed, Compare::kBoth, 30, 35},
};

/// A map of random surfaces in a random, rotated, anisotropic frame around the origin.
DepthMap randomMap(const Kind& kind, std::mt19937& random) {
    const auto [format, compare, width, height] = kind;
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    const auto direction = [&] {
        std::normal_distribution<float> normal;
        return glm::normalize(glm::vec3(normal(random), normal(random), normal(random)));
    };
    const glm::vec3 z = direction();
    const glm::vec3 x = glm::normalize(glm::cross(direction(), z));
    const glm::vec3 y = glm::cross(z, x);
    const bool cube = format == MapFormat::kCube8;

    DepthMap map;
    map.format = format;
    map.compare = compare;
    map.width = width;
    map.height = height;
    map.decode = unit(random) < 0.5F ? Decode::kPlane : Decode::kProjected;
    map.encloses = unit(random) < 0.5F;
    map.empty_is_outside = unit(random) < 0.5F;
    map.object_per_map = {1.0F + unit(random), 1.0F + unit(random), 1.0F + unit(random)};
    const glm::vec3 axes[3] = {x, y, z};
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 row = axes[i] / map.object_per_map[i];
        map.object_to_map.row[i] = glm::vec4(row, (cube ? 0.0F : 0.5F) + 0.2F * (unit(random) - 0.5F));
    }
    map.texels.resize(map.texelBytes());
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t j = 0; j < height; ++j) {
            for (std::uint32_t i = 0; i < width; ++i) {
                Texel texel;
                if (unit(random) < 0.8F) {
                    texel.front = Surface{cube ? 0.2F + unit(random) : unit(random), direction()};
                    if (isFrontBack(format) && unit(random) < 0.9F) {
                        texel.back = Surface{unit(random), direction()};
                    }
                    if (texel.back && unit(random) < 0.1F) {
                        texel.front.reset();
                    }
                }
                const std::span<std::byte> bytes = map.texelAt(face, i, j);
                if (texel.front && format == MapFormat::kFloat32) {
                    // As far from length 1 as a reader accepts: it is used unnormalized.
                    texel.front->normal *= 1.0F + 1.8e-3F * (unit(random) - 0.5F);
                }
                encodeTexel(format, texel, bytes);
                // An index that no baker writes; it reads as 254.
                if (texel.front && format != MapFormat::kFloat32 && unit(random) < 0.1F) {
                    bytes[unit(random) < 0.5F ? 0 : 1] = std::byte{255};
                }
            }
        }
    }
    return map;
}

std::vector<glm::vec3> randomPoints(std::size_t count, std::mt19937& random, float half = 0.8F) {
    std::uniform_real_distribution<float> within(-half, half);
    std::vector<glm::vec3> points(count);
    for (glm::vec3& p : points) {
        p = {within(random), within(random), within(random)};
    }
    return points;
}

std::string nameOf(const DepthMap& map) {
    return std::string(mapFormatName(map.format)) + " " + depthEncodingName(map.format) + " " +
           compareName(map.compare) + " " + decodeName(map.decode);
}

class FieldQueryGlTest : public GlTest {};

TEST_P(FieldQueryGlTest, EveryFormatCompareAndDecodeAgreesWithTheCpu) {
    std::mt19937 random(7);
    for (const Kind& kind : kKinds) {
        for (int repeat = 0; repeat < 8; ++repeat) {
            Collider collider;
            collider.maps.push_back(randomMap(kind, random));
            collider.maps[0].decode = repeat < 4 ? Decode::kProjected : Decode::kPlane;
            SCOPED_TRACE(nameOf(collider.maps[0]));
            collider.maps[0].encloses = (repeat & 1) != 0;
            collider.maps[0].empty_is_outside = (repeat & 2) != 0;
            expectAgreement(collider, randomPoints(8'000, random), 1.0F / 90.0F, 1e-3);
        }
    }
}

TEST_P(FieldQueryGlTest, AnyMixtureOfMapsAgreesWithTheCpu) {
    std::mt19937 random(11);
    for (int repeat = 0; repeat < 5; ++repeat) {
        Collider collider;
        for (int i = 0; i < 40; ++i) {
            Kind kind = kKinds[random() % std::size(kKinds)];
            kind.width = static_cast<std::uint32_t>(3 + random() % 60);
            kind.height =
                kind.format == MapFormat::kCube8 ? kind.width : static_cast<std::uint32_t>(3 + random() % 60);
            collider.maps.push_back(randomMap(kind, random));
        }
        // Forty maps have forty times as many borders.
        expectAgreement(collider, randomPoints(6'000, random), 1.0F / 60.0F, 5e-3);
    }
}

/// A random tree in a rotated frame around the origin, with roots of 2.5 units.
DepthMap turnedPatches(std::mt19937& random) {
    std::uniform_real_distribution<double> angle(0.0, 360.0);
    DepthMap map = test::randomPatches(random);
    const glm::dmat3 turn = test::rotation({1, 2, 3}, angle(random));
    map.object_per_map = glm::vec3(2.5F);
    map.encloses = random() % 2 == 0;
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 row = glm::vec3(turn[i]) / 2.5F;
        map.object_to_map.row[i] = glm::vec4(row, std::array{1.5F, 1.0F, 2.0F}[static_cast<std::size_t>(i)]);
    }
    return map;
}

// Twenty combinations: with no other maps, only planar maps, only a cube, or both; patches first, last or between.
TEST_P(FieldQueryGlTest, PatchesAgreeWithTheCpuAloneAndAmongOtherMaps) {
    std::mt19937 random(test::seedFrom(31));
    int decided = 0, by_patches = 0;
    for (unsigned repeat = 0; repeat < 20; ++repeat) {
        Collider collider;
        const unsigned company = repeat % 5;
        for (unsigned i = 0; i < company; ++i) {
            // Each of the ten formats in turn; only a cube if cubes are included.
            const Kind& kind =
                kKinds[company == 1 ? 5 + repeat / 5 % 2 : (3 * repeat + i) % std::size(kKinds)];
            DepthMap map = randomMap(kind, random);
            if (repeat % 2 == 0) {  // same size as the tree
                map.object_per_map *= 5.0F;
                for (glm::vec4& row : map.object_to_map.row) {
                    row = glm::vec4(glm::vec3(row) / 5.0F, row.w);
                }
            }
            collider.maps.push_back(std::move(map));
        }
        const auto place = static_cast<std::ptrdiff_t>(repeat / 2 % (company + 1));
        collider.maps.insert(collider.maps.begin() + place, turnedPatches(random));
        std::vector<glm::vec3> points = randomPoints(8'000, random, 5.0F);
        const std::vector<glm::vec3> near = randomPoints(8'000, random, repeat % 2 == 0 ? 4.0F : 0.8F);
        points.insert(points.end(), near.begin(), near.end());
        SCOPED_TRACE(repeat);
        expectAgreement(collider, points, 1.0F / 60.0F, 5e-3);
        for (std::size_t i = 0; company > 0 && i < points.size(); i += 20) {
            const FieldSample cpu = evaluate(collider, points[i]);
            decided += cpu.map >= 0 ? 1 : 0;
            by_patches += cpu.map == place ? 1 : 0;
        }
    }
    // Both often decide.
    EXPECT_GT(by_patches, decided / 5);
    EXPECT_LT(by_patches, decided - decided / 5);
}

TEST_P(FieldQueryGlTest, TexelBordersAndCubeCornersFallToEitherSide) {
    std::mt19937 random(13);
    for (const Kind& kind : kKinds) {
        Collider collider;
        collider.maps.push_back(randomMap(kind, random));
        SCOPED_TRACE(nameOf(collider.maps[0]));
        DepthMap& map = collider.maps[0];
        // Identity frame, so that the borders are exactly representable.
        map.object_per_map = glm::vec3(1.0F);
        map.object_to_map = {};
        std::vector<glm::vec3> points;
        for (std::uint32_t j = 0; j <= kind.height; ++j) {
            for (std::uint32_t i = 0; i <= kind.width; ++i) {
                const float x = static_cast<float>(i) / static_cast<float>(kind.width);
                const float y = static_cast<float>(j) / static_cast<float>(kind.height);
                for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
                    points.push_back(kind.format == MapFormat::kCube8 ? 0.7F * cubeDirection({face, x, y})
                                                                      : glm::vec3(x, y, 0.5F));
                }
            }
        }
        expectAgreement(collider, points, 1.0F / 90.0F, 1.0);
    }
}

TEST_P(FieldQueryGlTest, ExtremePointsNeverGiveNan) {
    std::mt19937 random(17);
    Collider collider;
    for (const Kind& kind : kKinds) {
        collider.maps.push_back(randomMap(kind, random));
        collider.maps.back().object_to_map.row[0].w = 0.0F;
    }
    const std::vector<glm::vec3> points = {{0, 0, 0},
                                           {1e30F, 0, 0},
                                           {-1e30F, 1e30F, -1e30F},
                                           {3e38F, 3e38F, 0},
                                           {1e-30F, -1e-38F, 0},
                                           {-0.0F, 0.0F, -0.0F},
                                           {1e16F, 1e16F, 1e16F}};
    const std::vector<FieldSample> samples = fieldOf(WorldTextures::create(collider).value(), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const FieldSample cpu = evaluate(collider, points[i]);
        EXPECT_FALSE(std::isnan(samples[i].distance)) << i;
        EXPECT_EQ(samples[i].map, cpu.map) << i;
        EXPECT_EQ(samples[i].inside(), cpu.inside()) << i;
    }
}

// Also for the probes of balls, which evaluate the map first that saw the ball: none is omitted, and the first of equal
// votes decides.
TEST_P(FieldQueryGlTest, EarlyOutAgreesWithTheCpu) {
    std::mt19937 random(29);
    std::size_t inside = 0;
    constexpr std::size_t kPoints = 10'000;
    for (int repeat = 0; repeat < 12; ++repeat) {
        Collider collider;
        for (int i = 0; i < 1 + repeat % 6; ++i) {
            collider.maps.push_back(randomMap(kKinds[random() % std::size(kKinds)], random));
            if (repeat % 2 == 0) {
                collider.maps.back().encloses = false;  // more points without an outside vote
                collider.maps.back().empty_is_outside = false;
            }
        }
        if (repeat % 4 == 0) {
            collider.maps.push_back(collider.maps.front());
        }
        const std::vector<glm::vec3> points = randomPoints(kPoints, random);
        const auto textures = required(WorldTextures::create(collider));
        const auto count = static_cast<int>(collider.maps.size());
        for (const int start : {-1, repeat % 2 == 0 ? count - 1 : count / 2}) {
            SCOPED_TRACE(std::to_string(repeat) + ", " + std::to_string(start));
            const bool probes = start >= 0;
            const std::vector<FieldSample> early =
                fieldOf(textures, points,
                        probes ? "#define RELIEF_QUERY_PROBE " + std::to_string(start) + "\n"
                               : "#define RELIEF_QUERY_INSIDE\n");
            double at_border = 0.0;
            for (std::size_t i = 0; i < kPoints; ++i) {
                const FieldSample& own = early[i];
                const auto agreesAt = [&](const glm::vec3& p) {
                    const InsideSample cpu = evaluateInside(collider, p);
                    // A probe may end at any map with an outside vote.
                    return own.inside() == cpu.inside && (own.map == cpu.map || (probes && !cpu.inside)) &&
                           glm::length(own.normal - cpu.normal) <= kNormal;
                };
                if (!agreesAt(points[i])) {
                    bool near = false;
                    for (int k = 0; k < 27 && !near; ++k) {
                        near = agreesAt(points[i] + kBorder / 90.0F * neighbour(k));
                    }
                    ASSERT_TRUE(near) << i;
                    ++at_border;
                }
                inside += own.inside() && !probes ? 1U : 0U;
            }
            EXPECT_LE(at_border, 2e-3 * kPoints);
        }
    }
    EXPECT_GT(inside, 12 * kPoints / 20);
    EXPECT_LT(inside, 12 * kPoints / 2);
}

TEST_P(FieldQueryGlTest, TooManyOrTooLargeMapsAreErrors) {
    std::mt19937 random(19);
    Collider collider;
    EXPECT_EQ(FieldQuery::create(collider).error().code, ErrorCode::kUnsupported);
    collider.maps.assign(20'000, randomMap({MapFormat::kFixed8, Compare::kLess, 3, 3}, random));
    EXPECT_EQ(FieldQuery::create(collider).error().code, ErrorCode::kLimit);
    collider.maps.resize(1);
    collider.maps[0].width = collider.maps[0].height = 1U << 16U;
    EXPECT_EQ(FieldQuery::create(collider).error().code, ErrorCode::kLimit);
}

/// A map may have more texels per row than GL textures allow, and the GPU uses only the maps' own bytes.
TEST_P(FieldQueryGlTest, MapsOfAnyShapeArePackedWithoutGaps) {
    std::mt19937 random(20);
    Collider collider;
    for (const MapFormat format : {MapFormat::kFixed8, MapFormat::kFrontBackFixed, MapFormat::kFloat32}) {
        const Compare compare = isFrontBack(format) ? Compare::kBoth : Compare::kLess;
        collider.maps.push_back(randomMap({format, compare, 20'000, 3}, random));
        collider.maps.push_back(randomMap({format, compare, 3, 777}, random));
    }
    collider.maps.push_back(randomMap({MapFormat::kCube8, Compare::kLess, 19, 19}, random));
    // A column is at most a hundred roundings of x wide.
    expectAgreement(collider, randomPoints(10'000, random), 1e-3F, 4e-2);
    const auto textures = WorldTextures::create(collider);
    ASSERT_TRUE(textures);
    EXPECT_GE(textures->bytes(), collider.texelBytes());
    EXPECT_LE(textures->bytes(), collider.texelBytes() + 1024 * (4 + 8 + 16))
        << "at most one row of padding each";
}

RELIEF_INSTANTIATE_GL_TESTS(FieldQueryGlTest);

}  // namespace
}  // namespace relief
