// SPDX-License-Identifier: Apache-2.0
// Votes against closed-form shapes: signs, scale, normals, and votes without data.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "formats/collider.h"
#include "formats/depth_map.h"
#include "formats/plane.h"
#include "formats/validate.h"
#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using namespace test;

double combined(double a, double b) {
    return a >= 0.0 && b >= 0.0 ? std::min(a, b) : std::max(a, b);
}

/// A texel's ray: starts at depth 0, along a unit vector.
struct TrueRay {
    glm::dvec3 from;
    glm::dvec3 direction;
    double object_per_depth;

    [[nodiscard]] glm::dvec3 at(double t) const { return from + t * direction; }
};

/// The expected vote of one end of a texel at P, and its tolerance. Bounds are derived, not fitted. Let n and S be the
/// shape's normal and hit on the texel's ray, and n_q and S_q the texel's values. The error of the plane is f_q(P) −
/// f(P) = (n_q − n)·(P − S) + n_q·(S − S_q). S − S_q lies along the ray, and its length is the quantum of the depth.
/// Float arithmetic adds a few roundings of T·P.
struct Expected {
    double distance;
    double bound;
};

Expected expectedOf(const DepthMap& map, const TrueRay& ray, const Hit& hit, bool leaves,
                    const glm::vec3& p) {
    const glm::dvec3 to_p = glm::dvec3(p) - ray.at(hit.t);
    const double quantum = ray.object_per_depth * depthQuantum(map.format, hit.t / ray.object_per_depth);
    if (map.decode == Decode::kPlane) {
        const glm::dvec3 stored = storedNormal(map.format, hit.normal);
        return {glm::dot(hit.normal, to_p), glm::length(stored - hit.normal) * glm::length(to_p) +
                                                std::abs(glm::dot(stored, ray.direction)) * quantum +
                                                roundingSlack(map, p, glm::length(to_p))};
    }
    const double behind = glm::dot(to_p, ray.direction);
    const Affine& rows = map.object_to_map;
    const glm::vec3& scale = map.object_per_map;
    const double rounding = map.projection() == Projection::kOrthographic
                                ? scale.z * transformSlack(rows.row[2], p)
                                : 3.0 * std::max({scale.x, scale.y, scale.z}) *
                                      (transformSlack(rows.row[0], p) + transformSlack(rows.row[1], p) +
                                       transformSlack(rows.row[2], p));
    return {leaves ? behind : -behind, quantum + rounding};
}

class VoteChecks {
  public:
    /// With planes, every point in a texel's column gets the distance to the shape's tangent plane at the hit of the
    /// centre ray. Projected texels vote the distance along that ray, with the shape's sign.
    void expect(const Shape& shape, const OrthographicFrame& frame, const Encoding& encoding, Decode decode) {
        SCOPED_TRACE(nameOf(encoding) + " " + decodeName(decode));
        start(makeMap(shape, frame, encoding.format, encoding.compare, 21, 17), decode);
        for (std::uint32_t y = 1; y + 1 < map_.height; ++y) {
            for (std::uint32_t x = 1; x + 1 < map_.width; ++x) {
                const TrueRay ray{frame.toObject({(x + 0.5) / map_.width, (y + 0.5) / map_.height, 0.0}),
                                  frame.axes[2], frame.sides.z};
                const std::vector<Hit> hits = texelHits(shape, frame, map_, x, y);
                for (int i = 0; i < 30; ++i) {
                    const glm::vec3 p(frame.toObject(
                        {(x + across()) / map_.width, (y + across()) / map_.height, within_(random_)}));
                    ASSERT_NO_FATAL_FAILURE(expectVote(shape, ray, hits, p)) << x << "," << y;
                }
            }
        }
        EXPECT_GT(checked_, 500);
        EXPECT_GT(signs_, decode == Decode::kPlane ? -1 : 50);
    }

    void expect(const Shape& shape, const CubeFrame& frame, Compare compare, Decode decode) {
        SCOPED_TRACE(std::string("cube ") + compareName(compare) + " " + decodeName(decode));
        constexpr std::uint32_t kSize = 12;
        start(makeMap(shape, frame, compare, kSize), decode);
        for (std::uint32_t texel = 0; texel < 6 * kSize * kSize; ++texel) {
            const std::uint32_t face = texel / (kSize * kSize);
            const glm::dvec3 toward = cubeTexelDirection(face, texel % kSize, texel / kSize % kSize, kSize);
            const glm::dvec3 through = frame.axes * (frame.half * glm::normalize(toward));
            const TrueRay ray{frame.center, glm::normalize(through), glm::length(through)};
            const std::vector<Hit> hits = shape.hits(frame.center, ray.direction);
            for (int i = 0; i < 20; ++i) {
                glm::dvec3 at = toward;
                for (int k = 0; k < 3; ++k) {
                    at[k] += k == static_cast<int>(face / 2) ? 0.0 : 2.0 / kSize * (across() - 0.5);
                }
                const glm::vec3 p(frame.toObject(within_(random_) * at));
                ASSERT_NO_FATAL_FAILURE(expectVote(shape, ray, hits, p)) << "texel " << texel;
            }
        }
        EXPECT_GT(checked_, 500);
    }

  private:
    void start(DepthMap map, Decode decode) {
        map_ = std::move(map);
        map_.decode = decode;
        checked_ = signs_ = 0;
        const Result<void> valid = validateFrame(map_).and_then([&] { return validateTexels(map_); });
        EXPECT_TRUE(valid) << valid.error().message;
    }

    /// The position of a point within its texel.
    double across() { return map_.decode == Decode::kPlane ? within_(random_) : 0.5; }

    void expectVote(const Shape& shape, const TrueRay& ray, const std::vector<Hit>& hits,
                    const glm::vec3& p) {
        const std::optional<Vote> got = vote(map_, p);
        ASSERT_TRUE(got);
        if (hits.empty()) {
            ASSERT_EQ(got->distance, kFarOutside);
            ASSERT_EQ(got->normal, glm::vec3(0.0F));
            return;
        }
        const bool both = map_.compare == Compare::kBoth;
        const bool last = map_.compare == Compare::kGreater;
        const Hit& front = last ? hits.back() : hits.front();
        const Hit& back = both ? hits.back() : front;
        const Expected a = expectedOf(map_, ray, front, last, p);
        const Expected b = both ? expectedOf(map_, ray, back, true, p) : a;
        const double bound = std::max(a.bound, b.bound);
        const auto stands = [&](const Hit& hit) {
            return std::abs(glm::dot(storedNormal(map_.format, hit.normal), ray.direction)) <
                   double{kPlaneCosineMin};
        };
        if (map_.decode == Decode::kPlane && (stands(front) || stands(back))) {
            return;  // the texel stores another value: see collider_test
        }
        if (both && map_.decode == Decode::kPlane &&
            std::min(std::abs(a.distance), std::abs(b.distance)) < bound) {
            return;  // at a sign change of one end the other decides
        }
        const double expected = combined(a.distance, b.distance);
        ASSERT_NEAR(got->distance, expected, bound);
        if (!both || std::abs(a.distance - b.distance) > 2.0 * bound) {
            ASSERT_LE(
                angleInDegrees(glm::dvec3(got->normal), expected == a.distance ? front.normal : back.normal),
                map_.format == MapFormat::kFloat32 ? 1e-4 : 0.65);
        }
        // A single map is right about points outside. A map of both ends of a convex shape is right everywhere.
        if (map_.decode == Decode::kProjected && std::abs(expected) > bound) {
            const bool inside = shape.inside(glm::dvec3(p));
            if (expected > 0.0 || both) {
                ASSERT_EQ(got->distance < 0.0F, inside);
            }
            signs_ += expected < 0.0 && inside ? 1 : 0;
        }
        ++checked_;
    }

    DepthMap map_;
    int checked_ = 0;
    int signs_ = 0;
    std::mt19937 random_{31};
    std::uniform_real_distribution<double> within_{0.002, 0.998};
};

TEST(Analytic, SphereBoxAndTorusInEveryFormatCompareAndDecode) {
    VoteChecks votes;
    const glm::dvec3 center(0.3, -0.2, 1.1);
    const auto sphere = makeSphere(center, 0.8);
    const glm::dvec3 middle(-1.0, 0.5, 0.0);
    const auto box = makeBox(middle, {0.5, 0.9, 0.25});
    const auto torus = makeTorus(1.0, 0.4);
    for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
        for (const Encoding& e : kOrthographic) {
            votes.expect(*sphere, centeredFrame(center, glm::dmat3(1.0), {2.0, 2.0, 2.0}), e, decode);
            votes.expect(*sphere, centeredFrame(center + 0.05, kTurned, {1.9, 2.4, 3.0}), e, decode);
            votes.expect(*box, centeredFrame(middle, glm::dmat3(1.0), {1.3, 2.1, 0.7}), e, decode);
            // A mirrored frame.
            const glm::dmat3 other(-kTurned[0], kTurned[1], kTurned[2]);
            votes.expect(*box, centeredFrame(middle, kTurned, {2.5, 2.25, 2.5}), e, decode);
            votes.expect(*box, centeredFrame(middle, other, {2.5, 2.25, 2.5}), e, decode);
            // Rotated about the torus axis, looking up and down.
            for (const glm::dmat3& axes :
                 {rotation({0, 0, 1}, 25.0), rotation({0, 0, 1}, 70.0) * rotation({1, 0, 0}, 180.0)}) {
                votes.expect(*torus, centeredFrame({0.01, 0.02, 0.0}, axes, {3.2, 3.3, 1.0}), e, decode);
            }
        }
    }
}

TEST(Analytic, CubesInsideAConvexShapeBesideItAndInATorusHole) {
    VoteChecks votes;
    const auto sphere = makeSphere({0.2, 0.1, -0.2}, 0.75);
    const auto box = makeBox({0.15, 0.2, -0.25}, {0.4, 0.5, 0.3});
    const auto torus = makeTorus(1.0, 0.6);
    for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
        for (const CubeFrame& frame : {CubeFrame{{0.1, 0.2, -0.3}, glm::dmat3(1.0), {1.0, 1.0, 1.0}},
                                       CubeFrame{{0.1, 0.2, -0.3}, kTurned, {1.0, 1.7, 1.25}}}) {
            votes.expect(*sphere, frame, Compare::kGreater, decode);
            votes.expect(*box, frame, Compare::kGreater, decode);
        }
        votes.expect(*makeSphere({1.2, 0.3, 0.0}, 0.6), {{0, 0, 0}, kTurned, {1.2, 1.3, 1.4}}, Compare::kLess,
                     decode);
        votes.expect(*torus, {{0, 0, 0}, glm::dmat3(1.0), {1.7, 1.7, 1.0}}, Compare::kLess, decode);
        votes.expect(*torus, {{0, 0, 0}, rotation({1, 1, 0}, 50.0), {2.0, 1.8, 1.7}}, Compare::kLess, decode);
    }
}

TEST(CubeCoordinates, MatchTheOpenGlTable) {
    // OpenGL 3.3, table 3.21: s = ½(sc/|ma| + 1), t = ½(tc/|ma| + 1), computed by hand for one direction per face.
    struct Row {
        glm::vec3 direction;
        CubeCoordinates expected;
    };
    const Row rows[] = {
        {{1.0F, 0.5F, 0.25F}, {0, 0.5F * (1 - 0.25F), 0.5F * (1 - 0.5F)}},   // sc −rz  tc −ry
        {{-1.0F, 0.5F, 0.25F}, {1, 0.5F * (1 + 0.25F), 0.5F * (1 - 0.5F)}},  // sc +rz  tc −ry
        {{0.5F, 1.0F, 0.25F}, {2, 0.5F * (1 + 0.5F), 0.5F * (1 + 0.25F)}},   // sc +rx  tc +rz
        {{0.5F, -1.0F, 0.25F}, {3, 0.5F * (1 + 0.5F), 0.5F * (1 - 0.25F)}},  // sc +rx  tc −rz
        {{0.5F, 0.25F, 1.0F}, {4, 0.5F * (1 + 0.5F), 0.5F * (1 - 0.25F)}},   // sc +rx  tc −ry
        {{0.5F, 0.25F, -1.0F}, {5, 0.5F * (1 - 0.5F), 0.5F * (1 - 0.25F)}},  // sc −rx  tc −ry
    };
    for (const Row& row : rows) {
        const CubeCoordinates at = cubeCoordinates(3.0F * row.direction);
        EXPECT_EQ(at.face, row.expected.face);
        EXPECT_FLOAT_EQ(at.s, row.expected.s);
        EXPECT_FLOAT_EQ(at.t, row.expected.t);
        EXPECT_LT(glm::length(cubeDirection(row.expected) - row.direction), 1e-6F);
    }
}

TEST(CubeCoordinates, TiesPreferXThenY) {
    EXPECT_EQ(cubeCoordinates({1, 1, 1}).face, 0U);
    EXPECT_EQ(cubeCoordinates({-1, 1, -1}).face, 1U);
    EXPECT_EQ(cubeCoordinates({0.5F, 1, 1}).face, 2U);
    EXPECT_EQ(cubeCoordinates({0.5F, -1, -1}).face, 3U);
}

/// [−2, 2]² × [−1, 1], all inner texels filled, with the surface at z = 0.
DepthMap plateMap(Compare compare) {
    const auto half_space = makeBox({0.0, 0.0, compare == Compare::kLess ? 50.0 : -50.0}, glm::dvec3(50.0));
    return makeMap(*half_space, centeredFrame({0, 0, 0}, glm::dmat3(1.0), {4.0, 4.0, 2.0}),
                   MapFormat::kFloat32, compare, 8, 8);
}

void expectFarOutside(const std::optional<Vote>& got, const std::string& what) {
    ASSERT_TRUE(got) << what;
    EXPECT_EQ(got->distance, kFarOutside) << what;
    EXPECT_EQ(got->normal, glm::vec3(0.0F)) << what;
}

TEST(ViewVolume, OnlyEnclosingMapsVoteOutsideTheWindow) {
    DepthMap map = plateMap(Compare::kLess);
    const glm::vec3 beside[] = {{2.5F, 0, 0}, {-2.5F, 0, 0}, {0, 2.5F, 0}, {0, -2.5F, 0}, {9, -9, 0.5F}};
    for (const glm::vec3& p : beside) {
        expectFarOutside(vote(map, p), "beside");
    }
    map.encloses = false;
    for (const glm::vec3& p : beside) {
        EXPECT_FALSE(vote(map, p));
    }
    EXPECT_TRUE(vote(map, {0, 0, 0.5F}));
    // A former fault: the distance at unknown points was below 0, which callers took for inside.
    Collider collider;
    collider.maps = {map};
    const FieldSample unknown = evaluate(collider, beside[0]);
    EXPECT_TRUE(unknown.map == -1 && unknown.distance == kFarOutside) << unknown.distance;
}

TEST(ViewVolume, BorderIsOutsideTheWindow) {
    DepthMap map = plateMap(Compare::kLess);
    // A surface in the border is ignored.
    for (std::uint32_t i = 0; i < 8; ++i) {
        for (const auto& [x, y] : {std::pair(i, 0U), {i, 7U}, {0U, i}, {7U, i}}) {
            encodeTexel(map.format, {Surface{0.5F, {0, 0, -1}}, std::nullopt}, map.texelAt(0, x, y));
        }
    }
    // A texel is half a unit wide: the border is [−2, −1.5] and [1.5, 2]. The lower edge belongs to the window.
    for (int axis = 0; axis < 2; ++axis) {
        for (const auto& [at, seen] :
             {std::pair(-1.75F, false), {-1.5F, true}, {1.499F, true}, {1.5F, false}, {1.75F, false}}) {
            glm::vec3 p(0.0F, 0.0F, 0.25F);
            p[axis] = at;
            ASSERT_TRUE(vote(map, p));
            EXPECT_EQ(vote(map, p)->distance < 0.0F, seen) << at;
        }
    }
}

TEST(ViewVolume, BeforeAndBehindTheVolume) {
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        DepthMap map = plateMap(compare);
        const float free_side = compare == Compare::kLess ? -1.0F : 1.0F;
        // The distance is valid on the free side. On the other side the collider has ended.
        EXPECT_FLOAT_EQ(vote(map, {0, 0, 5.0F * free_side})->distance, 5.0F);
        expectFarOutside(vote(map, {0, 0, -5.0F * free_side}), compareName(compare));
        EXPECT_FLOAT_EQ(vote(map, {0, 0, -0.75F * free_side})->distance, -0.75F);
        map.encloses = false;
        EXPECT_FALSE(vote(map, {0, 0, 5.0F}));
        EXPECT_FALSE(vote(map, {0, 0, -5.0F}));
        EXPECT_TRUE(vote(map, {0, 0, 1.0F})) << "the volume is closed";
        EXPECT_TRUE(vote(map, {0, 0, -1.0F})) << "the volume is closed";
    }
}

TEST(ViewVolume, EmptyTexelsVoteOnlyIfRaysStartInFreeSpace) {
    for (DepthMap map : {emptyMap(centeredFrame({0, 0, 0}, kTurned, {4.0, 4.0, 2.0}), MapFormat::kFixed8,
                                  Compare::kLess, 6, 6),
                         emptyMap(CubeFrame{{0, 0, 0}, kTurned, {2.0, 2.0, 1.0}}, Compare::kLess, 6)}) {
        expectFarOutside(vote(map, {0, 0, 0.1F}), "empty");
        map.empty_is_outside = false;
        EXPECT_FALSE(vote(map, {0, 0, 0.1F}));
        if (map.projection() == Projection::kOrthographic) {
            expectFarOutside(vote(map, {20, 0, 0}), "encloses still applies outside the window");
        }
    }
}

TEST(ViewVolume, CubeAtItsCentreAndOutsideItsVolume) {
    DepthMap map = makeMap(*makeSphere({0, 0, 0}, 1.0),
                           CubeFrame{{0, 0, 0}, glm::dmat3(1.0), glm::dvec3(1.5)}, Compare::kGreater, 16);
    EXPECT_NEAR(vote(map, glm::vec3(0.0F))->distance, -1.0F, 1e-4F) << "at its centre";
    EXPECT_NEAR(vote(map, {40, 0, 0})->distance, 39.0F, 1e-2F);
    map.encloses = false;
    EXPECT_FALSE(vote(map, {1.6F, 0, 0}));
    EXPECT_NEAR(vote(map, {1.4F, 0, 0})->distance, 0.4F, 1e-2F);
    // A LESS cube, behind its surface and outside the volume: the collider has ended.
    map.compare = Compare::kLess;
    EXPECT_FALSE(vote(map, {1.6F, 0, 0}));
    map.encloses = true;
    expectFarOutside(vote(map, {1.6F, 0, 0}), "behind a LESS cube");
}

TEST(ViewVolume, FinitePointsNeverGiveNanAndFarPointsAreOutside) {
    constexpr float kMax = std::numeric_limits<float>::max();
    const auto ball = makeSphere({0, 0, 0}, 1.0);
    Collider collider =
        threeMaps(*ball, glm::dvec3(0.0), glm::dmat3(1.0), 1.0, 16, MapFormat::kFrontBackHalf);
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        collider.maps.push_back(plateMap(compare));
        // A thin volume in each direction: exactly one coordinate overflows.
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 half(2.0);
            half[axis] = 1e-3;
            collider.maps.push_back(makeMap(*ball, CubeFrame{{0, 0, 0}, kTurned, half}, compare, 4));
        }
    }
    // T·P overflows in frames this small.
    collider.maps.push_back(emptyMap(centeredFrame({1, 1, 1}, kTurned, {1e-6, 2e-6, 3e-6}),
                                     MapFormat::kFloat32, Compare::kGreater, 4, 4));
    const std::size_t small = collider.maps.size();
    for (const Encoding& e : kOrthographic) {
        for (const double scale : {1e-15, 1.0, 1e15}) {
            collider.maps.push_back(makeMap(*ball, centeredFrame({0, 0, 0}, kTurned, {2.5, 2.5 * scale, 2.5}),
                                            e.format, e.compare, 12, 12));
        }
    }
    const float values[] = {0.0F, 1e-40F, -1e4F, 3e9F, -1e15F, 1e19F, -1e30F, kMax, -kMax};
    for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
        for (DepthMap& map : collider.maps) {
            map.decode = decode;
        }
        for (int i = 0; i < 9 * 9 * 9; ++i) {
            const glm::vec3 p(values[i % 9], values[i / 9 % 9], values[i / 81]);
            SCOPED_TRACE(testing::Message() << p.x << " " << p.y << " " << p.z);
            const bool far = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 10.0F;
            for (std::size_t k = 0; k < collider.maps.size(); ++k) {
                DepthMap& map = collider.maps[k];
                for (const bool encloses : {false, true}) {
                    map.encloses = encloses;
                    const std::optional<Vote> got = vote(map, p);
                    ASSERT_TRUE(got || !encloses);
                    ASSERT_FALSE(got &&
                                 std::isnan(got->distance + got->normal.x + got->normal.y + got->normal.z));
                    ASSERT_TRUE(!far || !got || k >= small || (encloses && got->distance > 0.0F)) << k;
                }
            }
            const FieldSample sample = evaluate(collider, p);
            ASSERT_FALSE(far && sample.inside());
            ASSERT_EQ(evaluateInside(collider, p).inside, sample.inside());
        }
    }
}

}  // namespace
}  // namespace relief
