// SPDX-License-Identifier: Apache-2.0
// Colliders: texels, plane votes that analytic_test does not cover, and normal indices.
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "formats/collider.h"
#include "formats/normal_index.h"
#include "formats/plane.h"
#include "formats/texel.h"
#include "tests/formats/analytic_shapes.h"

namespace relief::test {
namespace {

/// A 3×3 float map over [−2, 2]³ that votes `distance` at the origin, or abstains.
DepthMap voter(std::optional<float> distance) {
    // z_scale 4 and z' = ½ at the origin: distance = 4 · (depth − ½).
    DepthMap map = test::emptyMap(test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {4, 4, 4}),
                                  MapFormat::kFloat32, Compare::kLess, 3, 3);
    if (distance == kFarOutside) {
        return map;
    }
    if (!distance) {
        map.empty_is_outside = false;
        return map;
    }
    // The normal identifies the voter.
    const glm::dvec3 normal = test::rotation({0, 0, 1}, *distance * 40.0)[0];
    encodeTexel(map.format, {Surface{*distance / 4.0F + 0.5F, glm::vec3(normal)}, std::nullopt},
                map.texelAt(0, 1, 1));
    return map;
}

using MapVotes = std::vector<std::optional<float>>;

Collider colliderOf(const MapVotes& votes) {
    Collider collider;
    for (const std::optional<float>& v : votes) {
        collider.maps.push_back(voter(v));
    }
    return collider;
}

const glm::vec3 kOrigin(0.0F);
constexpr float kFar = kFarOutside;

TEST(Rule2, OutsideWinsThenTheVoteNearestToZero) {
    const auto distance = [](const MapVotes& votes) { return evaluate(colliderOf(votes), kOrigin).distance; };
    EXPECT_EQ(distance({-1.0F, -0.25F, -0.5F}), -0.25F);
    EXPECT_EQ(distance({-1.0F, 1.5F, -0.5F}), 1.5F);
    EXPECT_EQ(distance({1.0F, 0.25F, -0.5F, 0.5F}), 0.25F);
    EXPECT_EQ(distance({-0.25F, kFar}), kFar);
    EXPECT_EQ(distance({kFar, 1.0F}), 1.0F);
    EXPECT_EQ(distance({std::nullopt, -1.0F}), -1.0F);
    EXPECT_EQ(distance({-1.0F, 0.0F}), 0.0F);
}

// A wrong bit would move a box that a body or a view turns.
TEST(Bounds, CornersFollowTheBitsOfTheirIndex) {
    const Bounds box{{-1, -2, -9}, {4, 5, 6}};
    EXPECT_EQ(box.corner(0), box.min);
    EXPECT_EQ(box.corner(1), glm::vec3(4, -2, -9));
    EXPECT_EQ(box.corner(2), glm::vec3(-1, 5, -9));
    EXPECT_EQ(box.corner(4), glm::vec3(-1, -2, 6));
    EXPECT_EQ(box.corner(7), box.max);
    EXPECT_EQ(box.farthest(), 9.0F);
}

// Exact powers of two: a transposed matrix, which glm makes easy, would differ.
TEST(Affine, InverseUndoesTheLinearPart) {
    const Affine affine{{{2, 4, 0, 7}, {0, 8, 16, -3}, {0, 0, 0.5, 1}}};
    const glm::dvec3 p(3, -5, 11);
    EXPECT_EQ(affine.linear() * p, glm::dvec3(affine.apply(p)) - glm::dvec3(affine.apply({0, 0, 0})));
    EXPECT_EQ(affine.inverse() * (affine.linear() * p), p);
}

TEST(InsideBox, IsTheIntersectionOfEnclosingVolumes) {
    Collider collider = colliderOf({-1.0F, -1.0F, -1.0F});
    const auto place = [&](std::size_t map, const glm::dvec3& center, bool encloses) {
        const DepthMap placed = test::emptyMap(test::centeredFrame(center, glm::dmat3(1.0), {4, 4, 4}),
                                               MapFormat::kFloat32, Compare::kLess, 3, 3);
        collider.maps[map].object_to_map = placed.object_to_map;
        collider.maps[map].encloses = encloses;
        collider.maps[map].empty_is_outside = true;
    };
    place(0, {0, 0, 0}, true);
    place(1, {1, -1, 0}, true);
    place(2, {9, 9, 9}, false);
    const std::optional<Bounds> box = insideBox(collider);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->min, glm::vec3(-1, -2, -2));
    EXPECT_EQ(box->max, glm::vec3(2, 1, 2));
    // The squares of these rows underflow in floats.
    for (DepthMap& map : collider.maps) {
        for (glm::vec4& row : map.object_to_map.row) {
            row = glm::vec4(1e-24F * glm::vec3(row), row.w);
        }
    }
    EXPECT_NEAR(insideBox(collider).value().max.x, 2e24, 1e19);
}

TEST(Rule2, OrderDoesNotMatter) {
    const MapVotes sets[] = {
        {-1.0F, -0.5F, -0.25F, -1.5F, std::nullopt, -0.75F},
        {-1.0F, 0.5F, -0.25F, 1.5F, std::nullopt, kFar},
        {0.0F, 0.5F, -0.25F, kFar, -1.0F, std::nullopt},
        {0.0F, -0.5F, -0.25F, -1.0F, std::nullopt, -1.5F},
        {kFar, -0.5F, std::nullopt, -0.25F, -1.0F, -1.5F},
        {0.25F, 0.5F, 0.75F, 1.0F, 1.5F, kFar},
    };
    for (const MapVotes& votes : sets) {
        const Collider first = colliderOf(votes);
        const FieldSample expected = evaluate(first, kOrigin);
        std::vector<std::size_t> order(votes.size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        do {
            Collider shuffled;
            for (const std::size_t i : order) {
                shuffled.maps.push_back(first.maps[i]);
            }
            const FieldSample sample = evaluate(shuffled, kOrigin);
            ASSERT_EQ(sample.distance, expected.distance);
            ASSERT_EQ(sample.normal, expected.normal);
            ASSERT_EQ(order[static_cast<std::size_t>(sample.map)], static_cast<std::size_t>(expected.map));
        } while (std::next_permutation(order.begin(), order.end()));
    }
}

TEST(Rule2, NoVoteIsMapMinusOneAndOutside) {
    for (const MapVotes& votes : {MapVotes{}, MapVotes{std::nullopt}, MapVotes{std::nullopt, std::nullopt}}) {
        const FieldSample sample = evaluate(colliderOf(votes), kOrigin);
        EXPECT_EQ(sample.map, -1);
        EXPECT_FALSE(sample.inside());
        EXPECT_EQ(sample.normal, kOrigin);
    }
}

TEST(Rule2, FirstOfEqualVotesWins) {
    EXPECT_EQ(evaluate(colliderOf({std::nullopt, -0.5F, -0.5F}), kOrigin).map, 1);
    EXPECT_EQ(evaluate(colliderOf({-1.0F, 0.5F, 0.5F, kFar}), kOrigin).map, 1);
    EXPECT_EQ(evaluate(colliderOf({-1.0F, kFar, kFar}), kOrigin).map, 1);
    EXPECT_EQ(evaluate(colliderOf({0.0F, 0.0F}), kOrigin).map, 0);
}

TEST(Rule2, NormalComesFromTheDecidingMapAndIsZeroFarOutside) {
    EXPECT_EQ(evaluate(colliderOf({-0.5F, kFar}), kOrigin).normal, kOrigin);
    const Collider collider = colliderOf({-0.5F, 0.25F, kFar});
    const FieldSample sample = evaluate(collider, kOrigin);
    EXPECT_EQ(sample.map, 1);
    EXPECT_EQ(sample.normal, vote(collider.maps[1], kOrigin)->normal);
    EXPECT_FALSE(sample.inside());
    EXPECT_TRUE(evaluate(colliderOf({-0.5F}), kOrigin).inside());
}

/// `inside` agrees with evaluate(). Inside, so do normal and map. Outside, the map is the first that votes outside.
void expectInsideAgrees(const Collider& collider, const glm::vec3& p) {
    const FieldSample full = evaluate(collider, p);
    const InsideSample early = evaluateInside(collider, p);
    ASSERT_EQ(early.inside, full.inside());
    if (early.inside) {
        ASSERT_EQ(early.normal, full.normal);
        ASSERT_EQ(early.map, full.map);
        return;
    }
    ASSERT_EQ(early.normal, glm::vec3(0.0F));
    int first = -1;
    for (std::size_t i = collider.maps.size(); i-- > 0;) {
        const std::optional<Vote> v = vote(collider.maps[i], p);
        first = v && v->distance >= 0.0F ? static_cast<int>(i) : first;
    }
    ASSERT_EQ(early.map, first);
}

TEST(Inside, IsTheSignOfEvaluateForAnyVoteOrder) {
    MapVotes votes = {std::nullopt, -1.0F, -0.25F, 0.0F, 0.5F, kFar, std::nullopt, -0.25F};
    std::sort(votes.begin(), votes.end());
    do {
        expectInsideAgrees(colliderOf({votes.begin(), votes.begin() + 4}), kOrigin);
    } while (std::next_permutation(votes.begin(), votes.end()));
    expectInsideAgrees({}, kOrigin);
}

TEST(Inside, StopsAtTheFirstOutsideVote) {
    // The second map has no texels, so it must not be read.
    Collider collider = colliderOf({-0.5F, 0.25F, -0.5F});
    collider.maps[2].texels.clear();
    EXPECT_FALSE(evaluateInside(collider, kOrigin).inside);
}

TEST(PlaneDecode, VolumeWindowAndEmptyTexelsMatchProjected) {
    const auto sphere = makeSphere({0, 0, 0}, 0.7);
    std::vector<DepthMap> maps;
    for (const Encoding& e : kOrthographic) {
        maps.push_back(
            makeMap(*sphere, centeredFrame({0, 0, 0}, kTurned, {2, 2.2, 2.4}), e.format, e.compare, 12, 13));
    }
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        maps.push_back(makeMap(*sphere, CubeFrame{{0.9, 0, 0}, kTurned, {1.8, 2.0, 2.2}}, compare, 8));
    }
    std::mt19937 random(9);
    std::uniform_real_distribution<float> within(-2.5F, 2.5F);
    int same = 0;
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p(within(random), within(random), within(random));
        for (DepthMap map : maps) {
            for (const int flags : {0, 1, 2, 3}) {
                map.encloses = (flags & 1) != 0;
                map.empty_is_outside = (flags & 2) != 0;
                map.decode = Decode::kProjected;
                const std::optional<Vote> projected = vote(map, p);
                map.decode = Decode::kPlane;
                const std::optional<Vote> plane = vote(map, p);
                ASSERT_EQ(projected.has_value(), plane.has_value());
                if (plane && plane->normal == glm::vec3(0.0F)) {
                    ASSERT_EQ(plane->distance, kFarOutside);
                    ++same;
                }
                if (!map.encloses || !plane) {
                    continue;
                }
                // Step 5: an enclosing map votes inside only within its volume.
                const float low = map.projection() == Projection::kCube ? -1.0F : 0.0F;
                const glm::vec3 in_map = map.object_to_map.apply(p);
                if (glm::clamp(in_map, low, 1.0F) != in_map) {
                    ASSERT_GE(plane->distance, 0.0F);
                }
            }
        }
    }
    EXPECT_GT(same, 1000);
}

TEST(TexelRay, MatchesTheFrame) {
    const OrthographicFrame frame = centeredFrame({2.0, -1.0, 0.5}, kTurned, {3.0, 1.0, 0.75});
    const DepthMap map = emptyMap(frame, MapFormat::kFixed8, Compare::kGreater, 9, 5);
    for (std::uint32_t y = 0; y < 5; ++y) {
        for (std::uint32_t x = 0; x < 9; ++x) {
            const TexelRay ray = texelRay(map, 0, x, y);
            for (const double depth : {0.0, 0.3, 1.0}) {
                const glm::dvec3 expected = frame.toObject({(x + 0.5) / 9, (y + 0.5) / 5, depth});
                EXPECT_LT(glm::length(ray.at(depth) - expected), 3e-6);
            }
        }
    }
    const CubeFrame cube{{2.0, -1.0, 0.5}, kTurned, {3.0, 1.0, 0.75}};
    const DepthMap cube_map = emptyMap(cube, Compare::kLess, 7);
    for (std::uint32_t texel = 0; texel < 6 * 49; ++texel) {
        const std::uint32_t face = texel / 49;
        const TexelRay ray = texelRay(cube_map, face, texel % 7, texel / 7 % 7);
        const glm::dvec3 unit = glm::normalize(cubeTexelDirection(face, texel % 7, texel / 7 % 7, 7));
        EXPECT_LT(glm::length(ray.at(1.25) - cube.toObject(1.25 * unit)), 5e-6);
        EXPECT_LT(glm::length(ray.origin - cube.center), 3e-6);
    }
}

std::vector<std::byte> bytesOf(std::initializer_list<int> values) {
    std::vector<std::byte> bytes;
    for (const int value : values) {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

/// Expects these bytes for the texel, and the texel from these bytes.
void expectBytes(MapFormat format, const Texel& texel, std::initializer_list<int> values) {
    SCOPED_TRACE(std::string(mapFormatName(format)) + " " + depthEncodingName(format));
    std::vector<std::byte> bytes(texelSize(format), std::byte{0xcc});
    encodeTexel(format, texel, bytes);
    EXPECT_EQ(bytes, bytesOf(values));
    const Texel read = decodeTexel(format, bytesOf(values));
    for (const auto& [given, got] : {std::pair(texel.front, read.front), {texel.back, read.back}}) {
        ASSERT_EQ(given.has_value(), got.has_value());
        if (given) {
            EXPECT_NEAR(got->depth, given->depth, test::depthQuantum(format, double{given->depth}));
            EXPECT_EQ(got->normal, given->normal);
        }
    }
}

TEST(Texel, ByteLayout) {
    const Surface front{0.25F, {1, 0, 0}};
    const Surface back{1.0F, {0, -1, 0}};
    // Code 1 + round(0.25 · 65534) = 16385 = 0x4001, high byte first.
    expectBytes(MapFormat::kFixed8, {front, {}}, {254, 127, 0x40, 0x01});
    // Code 1 + round(1/√3 · 65534) = 37837 = 0x93cd.
    expectBytes(MapFormat::kCube8, {back, {}}, {127, 0, 0x93, 0xcd});
    // Half 0.25 = 0x3400, 1 = 0x3c00; words little-endian, s in the high byte.
    expectBytes(MapFormat::kFrontBackHalf, {front, back}, {127, 254, 0, 127, 0, 0x34, 0, 0x3c});
    expectBytes(MapFormat::kFrontBackHalf, {front, {}}, {127, 254, 0, 0, 0, 0x34, 0, 0});
    expectBytes(MapFormat::kFrontBackFixed, {front, back}, {127, 254, 0, 127, 0x01, 0x40, 0xff, 0xff});
    expectBytes(MapFormat::kFrontBackFixed, {{}, Surface{0.0F, {1, 0, 0}}}, {0, 0, 127, 254, 0, 0, 1, 0});
    expectBytes(MapFormat::kFloat32, {front, {}},
                {0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3e});
    // Empty is all zero bits, except for float.
    expectBytes(MapFormat::kFixed8, {}, {0, 0, 0, 0});
    expectBytes(MapFormat::kCube8, {}, {0, 0, 0, 0});
    expectBytes(MapFormat::kFrontBackHalf, {}, {0, 0, 0, 0, 0, 0, 0, 0});
    expectBytes(MapFormat::kFrontBackFixed, {}, {0, 0, 0, 0, 0, 0, 0, 0});
    expectBytes(MapFormat::kFloat32, {}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0xbf});
}

TEST(Texel, DepthsHaveNames) {
    const char* const names[kMapFormatCount] = {"float32", "unorm16", "half", "unorm16", "unorm16", "unorm8"};
    for (int i = 0; i < kMapFormatCount; ++i) {
        EXPECT_STREQ(depthEncodingName(static_cast<MapFormat>(i)), names[i]);
    }
}

TEST(Texel, FixedDepthCodesRoundTripMonotonicallyWithinHalfAStep) {
    for (const float depth_max : {1.0F, kCubeDepthMax}) {
        float before = -1.0F;
        for (unsigned code = 1; code < 65536; ++code) {
            const float depth = decodeFixedDepth(static_cast<std::uint16_t>(code), depth_max);
            ASSERT_GT(depth, before);
            ASSERT_EQ(encodeFixedDepth(depth, depth_max), code);
            before = depth;
        }
        EXPECT_EQ(decodeFixedDepth(1, depth_max), 0.0F);
        EXPECT_NEAR(decodeFixedDepth(65535, depth_max), depth_max, 2e-7);
        const double bound = 0.5 * depth_max / 65534.0 + 0x1p-23 * depth_max;
        for (int i = 0; i <= 200'000; ++i) {
            const float depth = static_cast<float>(i) * 5e-6F * depth_max;
            ASSERT_NEAR(decodeFixedDepth(encodeFixedDepth(depth, depth_max), depth_max), depth, bound);
        }
        EXPECT_EQ(encodeFixedDepth(-0.5F, depth_max), 1);
        EXPECT_EQ(encodeFixedDepth(2.0F * depth_max, depth_max), 65535);
    }
}

TEST(Texel, HalfDepthCodesRoundTripMonotonicallyNeverEmptyOrSubnormal) {
    float before = 0.0F;
    for (std::uint16_t bits = 0x0400; bits <= 0x3c00; ++bits) {
        const float depth = decodeHalfDepth(bits);
        ASSERT_EQ(depth, std::ldexp(1.0F + static_cast<float>(bits & 0x3ff) / 1024.0F, (bits >> 10) - 15));
        ASSERT_GT(depth, before);
        ASSERT_EQ(encodeHalfDepth(depth), bits);
        before = depth;
    }
    std::uint16_t bits_before = 0x0400;
    for (int i = 0; i <= 200'000; ++i) {
        const float depth = static_cast<float>(i) * 5e-6F;
        const std::uint16_t bits = encodeHalfDepth(depth);
        ASSERT_GE(bits, bits_before);
        ASSERT_LE(bits, 0x3c00);
        if (depth >= 0x1p-14F) {
            ASSERT_NEAR(decodeHalfDepth(bits), depth, depth * 0x1p-11F);
        }
        bits_before = bits;
    }
    EXPECT_EQ(encodeHalfDepth(-1.0F), 0x0400);
    EXPECT_EQ(encodeHalfDepth(2.0F), 0x3c00);
}

using test::angleInDegrees;

/// Equation 3 of the paper, written independently in double precision.
glm::dvec3 equation3(NormalIndex index) {
    const double s = (std::min<int>(index.s, 254) - 127) / 127.0;
    const double t = (std::min<int>(index.t, 254) - 127) / 127.0;
    const double z = 1.0 - std::abs(s) - std::abs(t);
    if (std::abs(s) + std::abs(t) <= 1.0) {
        return glm::normalize(glm::dvec3(s, t, z));
    }
    return glm::normalize(glm::dvec3((s >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(t)),
                                     (t >= 0 ? 1.0 : -1.0) * (1.0 - std::abs(s)), z));
}

NormalIndex indexOf(unsigned packed) {
    return unpackNormal(static_cast<std::uint16_t>(packed));
}

TEST(NormalIndex, SixAxesAreExact) {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {1.0F, -1.0F}) {
            glm::vec3 n(0.0F);
            n[axis] = sign;
            EXPECT_EQ(decodeNormal(encodeNormal(n)), n) << "axis " << axis << " sign " << sign;
        }
    }
}

TEST(NormalIndex, EveryIndexMatchesEquation3AndRoundTrips) {
    for (unsigned packed = 0; packed < 65536; ++packed) {
        const glm::vec3 decoded = decodeNormal(indexOf(packed));
        ASSERT_NEAR(glm::length(glm::dvec3(decoded)), 1.0, 2e-7) << packed;
        ASSERT_LT(glm::length(glm::dvec3(decoded) - equation3(indexOf(packed))), 4e-7) << packed;
        ASSERT_EQ(decodeNormal(encodeNormal(decoded)), decoded) << packed;
    }
}

TEST(NormalIndex, LengthDoesNotMatter) {
    std::mt19937 random(3);
    std::normal_distribution<float> gauss;
    for (int i = 0; i < 10000; ++i) {
        const glm::vec3 n(gauss(random), gauss(random), gauss(random));
        const NormalIndex index = encodeNormal(n);
        // Scaling by a power of two preserves the direction exactly.
        ASSERT_EQ(encodeNormal(n * 0x1p-60F), index);
        ASSERT_EQ(encodeNormal(n * 0x1p+60F), index);
    }
}

TEST(NormalIndex, PackingKeepsBothBytes) {
    EXPECT_EQ(packNormal({0x12, 0x34}), 0x1234);
    EXPECT_EQ(unpackNormal(0x1234), (NormalIndex{0x12, 0x34}));
}

// Rounding each coordinate independently would be up to 0.95 degrees off.
TEST(NormalIndex, BestOfFourErrorIsBelow065Degrees) {
    std::mt19937_64 random(20240701);
    std::normal_distribution<double> gauss;
    double worst = 0.0;
    for (int i = 0; i < 400'000; ++i) {
        const glm::vec3 n(glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random))));
        worst = std::max(worst, angleInDegrees(glm::dvec3(decodeNormal(encodeNormal(n))), glm::dvec3(n)));
    }
    EXPECT_LE(worst, 0.65);
    EXPECT_GT(worst, 0.55) << "too accurate: does this still test 8+8-bit indices?";
}

}  // namespace
}  // namespace relief::test
