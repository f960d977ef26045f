// Votes against closed-form shapes: signs, scale, normals, and what a map says where it knows nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "formats/collider.h"
#include "formats/depth_map.h"
#include "formats/validate.h"
#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using namespace test;

struct Encoding {
    MapFormat format;
    Compare compare;
};
constexpr Encoding kOrthographic[] = {
    {MapFormat::kFloat32, Compare::kLess},       {MapFormat::kFloat32, Compare::kGreater},
    {MapFormat::kFixed8, Compare::kLess},        {MapFormat::kFixed8, Compare::kGreater},
    {MapFormat::kFrontBackHalf, Compare::kBoth}, {MapFormat::kFrontBackFixed, Compare::kBoth}};

std::string nameOf(const Encoding& e) {
    return std::string(mapFormatName(e.format)) + " " + depthEncodingName(e.format) + " " +
           compareName(e.compare);
}

/// How far a stored depth may be from the one given, in map units.
double depthQuantum(MapFormat format, double depth) {
    switch (format) {
        case MapFormat::kFloat32:
            return depth * 0x1p-24;
        case MapFormat::kFrontBackHalf:
            return std::max(depth * 0x1p-11, depth < 0x1p-14 ? 0x1p-14 : 0.0);
        case MapFormat::kFixed8:
        case MapFormat::kFrontBackFixed:
            return 0.5 / 65534.0 + 0x1p-22;
        case MapFormat::kCube8:
            return 0.5 * kCubeDepthMax / 65534.0 + 0x1p-22;
        case MapFormat::kPatches:
            break;
    }
    return 0.0;
}

double normalTolerance(MapFormat format) {
    return format == MapFormat::kFloat32 ? 1e-4 : 0.65;  // degrees
}

/// Rounding of T·P in float, in map units: the row's entries, three products, three sums.
double transformSlack(const glm::vec4& row, const glm::vec3& p) {
    const double terms = std::abs(static_cast<double>(row.x) * p.x) +
                         std::abs(static_cast<double>(row.y) * p.y) +
                         std::abs(static_cast<double>(row.z) * p.z) + std::abs(static_cast<double>(row.w));
    return 8.0 * 0x1p-24 * terms;
}

/// Rule 2, in words of its own.
double combined(double a, double b) {
    if (a >= 0.0 && b >= 0.0) {
        return std::min(a, b);
    }
    return std::max(a, b);
}

/// Along the rays through texel centres a map's vote is the distance to the surface along the ray, up to
/// quantisation; the normal is the surface's; the sign is the shape's.
void expectRayDistances(const Shape& shape, const OrthographicFrame& frame, const Encoding& encoding) {
    SCOPED_TRACE(nameOf(encoding));
    const DepthMap map = makeMap(shape, frame, encoding.format, encoding.compare, 21, 17);
    const Result<void> valid = validateFrame(map).and_then([&] { return validateTexels(map); });
    ASSERT_TRUE(valid) << valid.error().message;
    int checked = 0;
    int signs = 0;
    for (std::uint32_t y = 1; y + 1 < map.height; ++y) {
        for (std::uint32_t x = 1; x + 1 < map.width; ++x) {
            const std::vector<Hit> hits = texelHits(shape, frame, map, x, y);
            for (double z = 0.01; z < 1.0 && !hits.empty(); z += 0.0375) {
                const glm::vec3 p(frame.toObject({(x + 0.5) / map.width, (y + 0.5) / map.height, z}));
                const double along = frame.toMap(glm::dvec3(p)).z * frame.sides.z;  // of P as rounded
                const double to_front = hits.front().t - along;
                const double from_back = along - hits.back().t;
                const double expected = encoding.compare == Compare::kLess ? to_front
                                        : encoding.compare == Compare::kGreater
                                            ? from_back
                                            : combined(to_front, from_back);
                const double bound =
                    frame.sides.z * (std::max(depthQuantum(encoding.format, hits.front().t / frame.sides.z),
                                              depthQuantum(encoding.format, hits.back().t / frame.sides.z)) +
                                     transformSlack(map.object_to_map.row[2], p));
                const std::optional<Vote> got = vote(map, p);
                ASSERT_TRUE(got);
                ASSERT_NEAR(got->distance, expected, bound) << "texel " << x << "," << y << " z' " << z;
                if (std::abs(to_front - from_back) > 2.0 * bound) {
                    const Hit& hit = expected == to_front ? hits.front() : hits.back();
                    ASSERT_LE(angleInDegrees(glm::dvec3(got->normal), hit.normal),
                              normalTolerance(encoding.format));
                }
                // What a single map calls outside is outside, and a map of both ends of a convex shape is
                // right.
                if (std::abs(expected) > bound) {
                    if (expected > 0.0 || encoding.compare == Compare::kBoth) {
                        ASSERT_EQ(got->distance < 0.0F, shape.inside(glm::dvec3(p)));
                    }
                    signs += expected < 0.0 && shape.inside(glm::dvec3(p)) ? 1 : 0;
                }
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 500);
    EXPECT_GT(signs, 50);
}

const glm::dmat3 kTurned = rotation({1.0, 2.0, -0.5}, 37.0);

TEST(Analytic, SphereAlongRays) {
    const glm::dvec3 center(0.3, -0.2, 1.1);
    const auto sphere = makeSphere(center, 0.8);
    for (const Encoding& encoding : kOrthographic) {
        expectRayDistances(*sphere, centeredFrame(center, glm::dmat3(1.0), {2.0, 2.0, 2.0}), encoding);
        expectRayDistances(*sphere, centeredFrame(center + 0.05, kTurned, {1.9, 2.4, 3.0}), encoding);
    }
}

TEST(Analytic, BoxAlongRays) {
    const auto box = makeBox({-1.0, 0.5, 0.0}, {0.5, 0.9, 0.25});
    for (const Encoding& encoding : kOrthographic) {
        expectRayDistances(*box, centeredFrame({-1.0, 0.5, 0.0}, glm::dmat3(1.0), {1.3, 2.1, 0.7}), encoding);
        expectRayDistances(*box, centeredFrame({-1.0, 0.5, 0.0}, kTurned, {2.5, 2.25, 2.5}), encoding);
    }
}

TEST(Analytic, TorusAlongItsAxis) {
    const auto torus = makeTorus(1.0, 0.4);
    // Turned about the torus' own axis, and looking up as well as down.
    for (const glm::dmat3& axes :
         {rotation({0, 0, 1}, 25.0), rotation({0, 0, 1}, 70.0) * rotation({1, 0, 0}, 180.0)}) {
        for (const Encoding& encoding : kOrthographic) {
            expectRayDistances(*torus, centeredFrame({0.01, 0.02, 0.0}, axes, {3.2, 3.3, 1.0}), encoding);
        }
    }
}

TEST(Analytic, TorusHoleIsOutside) {
    const auto torus = makeTorus(1.0, 0.4);
    const OrthographicFrame frame = centeredFrame({0, 0, 0}, glm::dmat3(1.0), {3.2, 3.2, 1.0});
    for (const Encoding& encoding : kOrthographic) {
        const std::optional<Vote> got =
            vote(makeMap(*torus, frame, encoding.format, encoding.compare, 32, 32), glm::vec3(0.02F));
        ASSERT_TRUE(got);
        EXPECT_EQ(got->distance, kFarOutside);
        EXPECT_EQ(got->normal, glm::vec3(0.0F));
    }
}

TEST(Analytic, HalfSpaceIsExactForAnyPoint) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const glm::dmat3& axes : {glm::dmat3(1.0), kTurned}) {
        const OrthographicFrame frame = centeredFrame({2.0, -1.0, 0.5}, axes, {3.0, 1.0, 0.75});
        for (const Encoding& encoding : kOrthographic) {
            if (encoding.compare == Compare::kBoth) {
                continue;  // a half-space has one surface; see SlabIsExactForAnyPoint
            }
            SCOPED_TRACE(nameOf(encoding));
            // The solid lies behind the plane as the kept surface sees it.
            const double side = encoding.compare == Compare::kLess ? -1.0 : 1.0;
            const glm::dvec3 normal = side * frame.axes[2];
            const double plane = glm::dot(normal, frame.toObject({0.5, 0.5, 0.37}));
            const DepthMap map =
                makeMap(*makeHalfSpace(normal, plane), frame, encoding.format, encoding.compare, 9, 8);
            for (int i = 0; i < 20000; ++i) {
                const glm::dvec3 at(0.125 + 0.75 * unit(random), 0.1251 + 0.7498 * unit(random),
                                    unit(random));
                const glm::vec3 p(frame.toObject(at));
                const double bound = frame.sides.z * (depthQuantum(encoding.format, 0.37) +
                                                      transformSlack(map.object_to_map.row[2], p));
                const std::optional<Vote> got = vote(map, p);
                ASSERT_TRUE(got);
                ASSERT_NEAR(got->distance, glm::dot(normal, glm::dvec3(p)) - plane, bound);
                ASSERT_LE(angleInDegrees(glm::dvec3(got->normal), normal), normalTolerance(encoding.format));
            }
        }
    }
}

TEST(Analytic, SlabIsExactForAnyPoint) {
    // A box wider than the map's window: front and back are planes there.
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto slab = makeBox({0.0, 0.0, 0.0}, {5.0, 5.0, 0.3});
    const OrthographicFrame frame = centeredFrame({0.0, 0.0, 0.1}, glm::dmat3(1.0), {2.0, 2.0, 1.6});
    const DepthMap map = makeMap(*slab, frame, MapFormat::kFrontBackHalf, Compare::kBoth, 8, 8);
    for (int i = 0; i < 20000; ++i) {
        const glm::vec3 p(
            frame.toObject({0.13 + 0.74 * unit(random), 0.13 + 0.74 * unit(random), unit(random)}));
        const double expected = std::abs(static_cast<double>(p.z)) - 0.3;
        const std::optional<Vote> got = vote(map, p);
        ASSERT_TRUE(got);
        ASSERT_NEAR(
            got->distance, expected,
            frame.sides.z * (depthQuantum(map.format, 1.0) + transformSlack(map.object_to_map.row[2], p)));
    }
}

/// The same for the rays of a cube's texels, from its centre.
void expectCubeDistances(const Shape& shape, const CubeFrame& frame, Compare compare) {
    SCOPED_TRACE(compareName(compare));
    constexpr std::uint32_t kSize = 12;
    const DepthMap map = makeMap(shape, frame, compare, kSize);
    const Result<void> valid = validateFrame(map).and_then([&] { return validateTexels(map); });
    ASSERT_TRUE(valid) << valid.error().message;
    const double longest = std::max({frame.half.x, frame.half.y, frame.half.z});
    int checked = 0;
    for (std::uint32_t texel = 0; texel < 6 * kSize * kSize; ++texel) {
        const std::uint32_t face = texel / (kSize * kSize);
        const glm::dvec3 toward = cubeTexelDirection(face, texel % kSize, texel / kSize % kSize, kSize);
        const glm::dvec3 direction = glm::normalize(frame.axes * (frame.half * toward));
        const std::vector<Hit> hits = shape.hits(frame.center, direction);
        for (double largest = 0.07; largest < 1.0 && !hits.empty(); largest += 0.0925) {
            const glm::vec3 p(frame.toObject(largest * toward));
            const double along = glm::length(glm::dvec3(p) - frame.center);
            const Hit& hit = compare == Compare::kLess ? hits.front() : hits.back();
            const double expected = compare == Compare::kLess ? hit.t - along : along - hit.t;
            const double bound = longest * (depthQuantum(MapFormat::kCube8, 0.0) +
                                            3.0 * (transformSlack(map.object_to_map.row[0], p) +
                                                   transformSlack(map.object_to_map.row[1], p) +
                                                   transformSlack(map.object_to_map.row[2], p)));
            const std::optional<Vote> got = vote(map, p);
            ASSERT_TRUE(got);
            ASSERT_NEAR(got->distance, expected, bound) << "face " << face << " largest " << largest;
            ASSERT_LE(angleInDegrees(glm::dvec3(got->normal), hit.normal), 0.65);
            if (expected > bound) {
                ASSERT_FALSE(shape.inside(glm::dvec3(p)));
            }
            ++checked;
        }
    }
    EXPECT_GT(checked, 500);
}

TEST(Analytic, CubeGreaterFromInsideAConvexShape) {
    const CubeFrame straight{{0.1, 0.2, -0.3}, glm::dmat3(1.0), {1.0, 1.0, 1.0}};
    const CubeFrame turned{{0.1, 0.2, -0.3}, kTurned, {1.0, 1.7, 1.25}};
    for (const CubeFrame& frame : {straight, turned}) {
        expectCubeDistances(*makeSphere({0.2, 0.1, -0.2}, 0.75), frame, Compare::kGreater);
        expectCubeDistances(*makeBox({0.15, 0.2, -0.25}, {0.4, 0.5, 0.3}), frame, Compare::kGreater);
    }
}

TEST(Analytic, CubeLessFromTheHoleOfATorus) {
    const auto torus = makeTorus(1.0, 0.6);
    expectCubeDistances(*torus, {{0, 0, 0}, glm::dmat3(1.0), {1.7, 1.7, 1.0}}, Compare::kLess);
    expectCubeDistances(*torus, {{0, 0, 0}, rotation({1, 1, 0}, 50.0), {2.0, 1.8, 1.7}}, Compare::kLess);
}

TEST(Analytic, CubeLessFromFreeSpaceBesideAShape) {
    // The rays that miss the sphere are free: outside when the map says so, silent when it does not.
    const CubeFrame frame{{0, 0, 0}, kTurned, {2.0, 2.5, 2.0}};
    const auto sphere = makeSphere({1.2, 0.3, 0.0}, 0.6);
    expectCubeDistances(*sphere, {{0, 0, 0}, kTurned, {1.2, 1.3, 1.4}}, Compare::kLess);
    DepthMap map = makeMap(*sphere, frame, Compare::kLess, 24);
    const glm::vec3 away(-1.0F, -0.2F, 0.1F);
    ASSERT_TRUE(vote(map, away));
    EXPECT_EQ(vote(map, away)->distance, kFarOutside);
    map.empty_is_outside = false;
    EXPECT_FALSE(vote(map, away));
}

TEST(CubeCoordinates, TableOfOpenGL) {
    // Table 3.21 of OpenGL 3.3: s = ½(sc/|ma| + 1), t = ½(tc/|ma| + 1), by hand for one direction a face.
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

TEST(CubeCoordinates, EqualComponentsGoToXThenY) {
    EXPECT_EQ(cubeCoordinates({1, 1, 1}).face, 0U);
    EXPECT_EQ(cubeCoordinates({-1, 1, -1}).face, 1U);
    EXPECT_EQ(cubeCoordinates({0.5F, 1, 1}).face, 2U);
    EXPECT_EQ(cubeCoordinates({0.5F, -1, -1}).face, 3U);
}

TEST(CubeCoordinates, DirectionIsTheInverse) {
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (float s = 0.03125F; s < 1.0F; s += 0.0625F) {
            for (float t = 0.03125F; t < 1.0F; t += 0.0625F) {
                const CubeCoordinates at = cubeCoordinates(cubeDirection({face, s, t}));
                EXPECT_EQ(at.face, face);
                EXPECT_NEAR(at.s, s, 1e-6F);
                EXPECT_NEAR(at.t, t, 1e-6F);
            }
        }
    }
}

// ---- a whole collider
// -----------------------------------------------------------------------------------------

/// Looks along +x, +y, +z in turn. The window leaves three texels around the shape's box.
Collider threeFrontBackMaps(const Shape& shape, const glm::dvec3& center, double half, std::uint32_t size) {
    Collider collider;
    const double side = 2.0 * half * size / (size - 6);
    const glm::dmat3 looks[] = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                                {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (const glm::dmat3& axes : looks) {
        collider.maps.push_back(makeMap(shape, centeredFrame(center, axes, glm::dvec3(side)),
                                        MapFormat::kFrontBackHalf, Compare::kBoth, size, size));
    }
    return collider;
}

TEST(Analytic, SphereByThreeFrontBackMapsIsRightButForATexelAtTheSurface) {
    constexpr std::uint32_t kSize = 64;
    constexpr double kRadius = 0.9;
    const glm::dvec3 center(0.4, -0.3, 0.2);
    const auto sphere = makeSphere(center, kRadius);
    const Collider collider = threeFrontBackMaps(*sphere, center, kRadius, kSize);
    const double side = 2.0 * kRadius * kSize / (kSize - 6);
    // P and the centre of its texel are half a texel's diagonal apart at most. So is what their rays see of
    // the sphere from them; the depth is off by a half-float's step along the ray.
    const double bound = std::sqrt(0.5) * side / kSize + side * (0x1p-11 + 1e-6);

    std::mt19937 random(17);
    std::uniform_real_distribution<double> within(-1.4 * kRadius, 1.4 * kRadius);
    int near_surface = 0;
    for (int i = 0; i < 300'000; ++i) {
        const glm::vec3 p(center + glm::dvec3(within(random), within(random), within(random)));
        const double distance = glm::length(glm::dvec3(p) - center) - kRadius;
        const FieldSample sample = evaluate(collider, p);
        ASSERT_GE(sample.map, 0);
        if (std::abs(distance) > bound) {
            ASSERT_EQ(sample.inside(), distance < 0.0) << "at distance " << distance;
        } else {
            ++near_surface;
        }
        // Along a ray no surface is nearer than the nearest: no vote is smaller than the true distance.
        if (distance > bound) {
            ASSERT_GE(sample.distance, distance - bound);
        } else if (distance < -bound) {
            ASSERT_LE(sample.distance, distance + bound);
        }
    }
    EXPECT_LT(near_surface, 300'000 / 10);
}

TEST(Analytic, BoxByThreeFrontBackMapsIsRightButForATexelAtTheSurface) {
    constexpr std::uint32_t kSize = 40;
    const glm::dvec3 half(0.7, 0.5, 0.6);
    const auto box = makeBox({0, 0, 0}, half);
    const Collider collider = threeFrontBackMaps(*box, {0, 0, 0}, 0.7, kSize);
    const double side = 1.4 * kSize / (kSize - 6);
    const double bound = 0.5 * side / kSize + side * (0x1p-11 + 1e-6);  // across the ray: per axis

    std::mt19937 random(18);
    std::uniform_real_distribution<double> within(-1.0, 1.0);
    for (int i = 0; i < 300'000; ++i) {
        const glm::vec3 p(glm::dvec3(within(random), within(random), within(random)));
        const glm::dvec3 beyond = glm::abs(glm::dvec3(p)) - half;
        if (std::max({beyond.x, beyond.y, beyond.z}) < -bound) {
            ASSERT_TRUE(evaluate(collider, p).inside());
        } else if (std::max({beyond.x, beyond.y, beyond.z}) > bound) {
            ASSERT_FALSE(evaluate(collider, p).inside());
        }
    }
}

// ---- what a map does not know
// ---------------------------------------------------------------------------------

/// [−2, 2]² × [−1, 1], every inner texel full with its surface at z = 0.
DepthMap plateMap(Compare compare, std::uint32_t size = 8) {
    const glm::dvec3 normal(0.0, 0.0, compare == Compare::kLess ? -1.0 : 1.0);
    return makeMap(*makeHalfSpace(normal, 0.0), centeredFrame({0, 0, 0}, glm::dmat3(1.0), {4.0, 4.0, 2.0}),
                   MapFormat::kFloat32, compare, size, size);
}

void expectFarOutside(const std::optional<Vote>& got, const std::string& what) {
    ASSERT_TRUE(got) << what;
    EXPECT_EQ(got->distance, kFarOutside) << what;
    EXPECT_EQ(got->normal, glm::vec3(0.0F)) << what;
}

TEST(ViewVolume, OutsideTheWindowIsFarOutsideIfTheMapEnclosesAndSilentOtherwise) {
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
}

TEST(ViewVolume, TheBorderIsOutsideTheWindow) {
    DepthMap map = plateMap(Compare::kLess);
    // A surface written into the border is never seen.
    for (std::uint32_t i = 0; i < 8; ++i) {
        for (const auto& [x, y] : {std::pair(i, 0U), {i, 7U}, {0U, i}, {7U, i}}) {
            encodeTexel(map.format, {Surface{0.5F, {0, 0, -1}}, std::nullopt}, map.texelAt(0, x, y));
        }
    }
    // A texel is half a unit wide: the border is [−2, −1.5] and [1.5, 2]. The lower edge belongs to the
    // window.
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
        // On the side of free space the distance still holds; on the other side nothing of the collider is
        // left.
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

TEST(ViewVolume, AnEmptyTexelIsFarOutsideIfRaysStartInFreeSpaceAndSilentOtherwise) {
    DepthMap map = emptyMap(centeredFrame({0, 0, 0}, kTurned, {4.0, 4.0, 2.0}), MapFormat::kFixed8,
                            Compare::kLess, 6, 6);
    expectFarOutside(vote(map, {0, 0, 0}), "empty");
    map.empty_is_outside = false;
    EXPECT_FALSE(vote(map, {0, 0, 0}));
    expectFarOutside(vote(map, {20, 0, 0}), "encloses still speaks outside the window");
}

TEST(ViewVolume, CubeOutsideItsVolume) {
    DepthMap map = makeMap(*makeSphere({0, 0, 0}, 1.0),
                           CubeFrame{{0, 0, 0}, glm::dmat3(1.0), glm::dvec3(1.5)}, Compare::kGreater, 16);
    EXPECT_NEAR(vote(map, {40, 0, 0})->distance, 39.0F, 1e-2F);
    map.encloses = false;
    EXPECT_FALSE(vote(map, {1.6F, 0, 0}));
    EXPECT_NEAR(vote(map, {1.4F, 0, 0})->distance, 0.4F, 1e-2F);
    // A LESS cube behind its surface, and outside the volume: nothing of the collider is left there.
    map.compare = Compare::kLess;
    EXPECT_FALSE(vote(map, {1.6F, 0, 0}));
    map.encloses = true;
    expectFarOutside(vote(map, {1.6F, 0, 0}), "behind a LESS cube");
}

TEST(ViewVolume, CubeCentreHasAVote) {
    const DepthMap map =
        makeMap(*makeSphere({0, 0, 0}, 1.0), CubeFrame{{0, 0, 0}, glm::dmat3(1.0), glm::dvec3(2.0)},
                Compare::kGreater, 5);
    ASSERT_TRUE(vote(map, glm::vec3(0.0F)));
    EXPECT_NEAR(vote(map, glm::vec3(0.0F))->distance, -1.0F, 1e-4F);
}

TEST(ViewVolume, NoFinitePointGivesNaNAndFarOnesAreOutside) {
    constexpr float kMax = std::numeric_limits<float>::max();
    Collider collider = threeFrontBackMaps(*makeSphere({0, 0, 0}, 1.0), {0, 0, 0}, 1.0, 16);
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        collider.maps.push_back(plateMap(compare));
        // A thin volume, in each direction: one coordinate overflows, alone, first or later.
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 half(2.0);
            half[axis] = 1e-3;
            collider.maps.push_back(
                makeMap(*makeSphere({0, 0, 0}, 1.0), CubeFrame{{0, 0, 0}, kTurned, half}, compare, 4));
        }
    }
    // Frames so small that T·P overflows.
    collider.maps.push_back(emptyMap(centeredFrame({1, 1, 1}, kTurned, {1e-6, 2e-6, 3e-6}),
                                     MapFormat::kFloat32, Compare::kGreater, 4, 4));
    const float values[] = {0.0F, 1e-40F, -1e4F, 3e9F, -1e15F, 1e19F, -1e30F, kMax, -kMax};
    for (const float x : values) {
        for (const float y : values) {
            for (const float z : values) {
                const glm::vec3 p(x, y, z);
                const bool far = std::max({std::abs(x), std::abs(y), std::abs(z)}) > 10.0F;
                for (DepthMap map : collider.maps) {
                    for (const bool encloses : {true, false}) {
                        map.encloses = encloses;
                        const std::optional<Vote> got = vote(map, p);
                        ASSERT_TRUE(got || !encloses);
                        if (got) {
                            ASSERT_FALSE(std::isnan(got->distance));
                            ASSERT_FALSE(std::isnan(got->normal.x + got->normal.y + got->normal.z));
                            ASSERT_TRUE(!far || got->distance > 0.0F) << x << " " << y << " " << z;
                        }
                        ASSERT_FALSE(far && !encloses && got) << x << " " << y << " " << z;
                    }
                }
            }
        }
    }
}

}  // namespace
}  // namespace relief
