// Votes of planes against closed-form shapes, and the helpers that writers of planes use.
//
// Bounds are derived, not fitted: with n and S the shape's normal and hit on a texel's ray, n_q and S_q what
// the texel holds, f_q(P) − f(P) = (n_q − n)·(P − S) + n_q·(S − S_q), where S − S_q lies along the ray and is
// as long as the quantum of the depth; and float arithmetic adds a few roundings of T·P.
#include "formats/plane.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <random>
#include <string>

#include "formats/collider.h"
#include "formats/normal_index.h"
#include "formats/validate.h"
#include "tests/formats/analytic_shapes.h"

namespace relief {
namespace {

using namespace test;

const glm::dmat3 kTurned = rotation({1.0, 2.0, -0.5}, 37.0);

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

glm::dvec3 storedNormal(MapFormat format, const glm::dvec3& normal) {
    const glm::vec3 single(normal);
    return glm::dvec3(format == MapFormat::kFloat32 ? single : decodeNormal(encodeNormal(single)));
}

/// Rounding of f in float, in object units: of T·P and of the products and sums behind it.
double roundingSlack(const DepthMap& map, const glm::vec3& p, double from_surface) {
    double slack = 16.0 * 0x1p-24 * from_surface;
    for (int k = 0; k < 3; ++k) {
        const glm::vec4& row = map.object_to_map.row[k];
        const double terms =
            std::abs(static_cast<double>(row.x) * p.x) + std::abs(static_cast<double>(row.y) * p.y) +
            std::abs(static_cast<double>(row.z) * p.z) + std::abs(static_cast<double>(row.w));
        slack += 8.0 * 0x1p-24 * (terms + 2.0) * map.object_per_map[k];
    }
    return slack;
}

/// What one end of a texel has to say of P, and how far a reader may be off.
struct Expected {
    double distance;
    double bound;
};
Expected expectedOf(const DepthMap& map, const Hit& hit, const glm::dvec3& from, const glm::dvec3& direction,
                    double object_per_depth, const glm::vec3& p) {
    const glm::dvec3 to_p = glm::dvec3(p) - (from + hit.t * direction);
    const glm::dvec3 stored = storedNormal(map.format, hit.normal);
    return {glm::dot(hit.normal, to_p), glm::length(stored - hit.normal) * glm::length(to_p) +
                                            std::abs(glm::dot(stored, direction)) * object_per_depth *
                                                depthQuantum(map.format, hit.t / object_per_depth) +
                                            roundingSlack(map, p, glm::length(to_p))};
}

/// Rule 2, in words of its own.
double combined(double a, double b) {
    return a >= 0.0 && b >= 0.0 ? std::min(a, b) : std::max(a, b);
}

class PlaneVotes {
  public:
    /// Anywhere in a texel's column the map votes the distance to the plane that touches the shape on the ray
    /// through the texel's centre.
    void expect(const Shape& shape, const OrthographicFrame& frame, const Encoding& encoding) {
        SCOPED_TRACE(nameOf(encoding));
        DepthMap map = makeMap(shape, frame, encoding.format, encoding.compare, 14, 11);
        map.decode = Decode::kPlane;
        ASSERT_TRUE(validateFrame(map).and_then([&] { return validateTexels(map); }));
        int checked = 0;
        for (std::uint32_t y = 1; y + 1 < map.height; ++y) {
            for (std::uint32_t x = 1; x + 1 < map.width; ++x) {
                const std::vector<Hit> hits = texelHits(shape, frame, map, x, y);
                const glm::dvec3 from = frame.toObject({(x + 0.5) / map.width, (y + 0.5) / map.height, 0.0});
                for (int i = 0; i < 60 && !hits.empty(); ++i) {
                    const glm::vec3 p(
                        frame.toObject({(x + within_(random_)) / map.width,
                                        (y + within_(random_)) / map.height, within_(random_)}));
                    const auto of = [&](const Hit& hit) {
                        return expectedOf(map, hit, from, frame.axes[2], frame.sides.z, p);
                    };
                    const bool both = encoding.compare == Compare::kBoth;
                    const Expected a = of(encoding.compare == Compare::kGreater ? hits.back() : hits.front());
                    const Expected b = both ? of(hits.back()) : a;
                    const double bound = std::max(a.bound, b.bound);
                    if (both && std::min(std::abs(a.distance), std::abs(b.distance)) < bound) {
                        continue;  // where an end changes sign the other takes over
                    }
                    const std::optional<Vote> got = vote(map, p);
                    ASSERT_TRUE(got);
                    ASSERT_NEAR(got->distance, combined(a.distance, b.distance), bound) << x << "," << y;
                    ++checked;
                }
            }
        }
        EXPECT_GT(checked, 500);
    }

    void expect(const Shape& shape, const CubeFrame& frame, Compare compare) {
        SCOPED_TRACE(std::string("cube ") + compareName(compare));
        constexpr std::uint32_t kSize = 9;
        DepthMap map = makeMap(shape, frame, compare, kSize);
        map.decode = Decode::kPlane;
        ASSERT_TRUE(validateFrame(map));
        int checked = 0;
        for (std::uint32_t texel = 0; texel < 6 * kSize * kSize; ++texel) {
            const std::uint32_t face = texel / (kSize * kSize);
            const std::uint32_t x = texel % kSize;
            const std::uint32_t y = texel / kSize % kSize;
            const glm::dvec3 through =
                frame.axes * (frame.half * glm::normalize(cubeTexelDirection(face, x, y, kSize)));
            const double object_per_depth = glm::length(through);
            const glm::dvec3 direction = through / object_per_depth;
            const std::vector<Hit> hits = shape.hits(frame.center, direction);
            for (int i = 0; i < 40 && !hits.empty(); ++i) {
                // cubeTexelDirection of a texel's corner, moved by a random part of a texel.
                const glm::dvec3 corner = cubeTexelDirection(face, x, y, kSize);
                glm::dvec3 at = corner;
                for (int k = 0; k < 3; ++k) {
                    at[k] += k == static_cast<int>(face / 2) ? 0.0 : 2.0 / kSize * (within_(random_) - 0.5);
                }
                const glm::vec3 p(frame.toObject(within_(random_) * at));
                const Expected expected =
                    expectedOf(map, compare == Compare::kLess ? hits.front() : hits.back(), frame.center,
                               direction, object_per_depth, p);
                const std::optional<Vote> got = vote(map, p);
                ASSERT_TRUE(got);
                ASSERT_NEAR(got->distance, expected.distance, expected.bound) << face << " " << x << "," << y;
                ++checked;
            }
        }
        EXPECT_GT(checked, 500);
    }

  private:
    std::mt19937 random_{31};
    std::uniform_real_distribution<double> within_{0.002, 0.998};
};

TEST(PlaneDecode, SphereBoxAndTorusInEveryFormatAndCompare) {
    PlaneVotes votes;
    const glm::dvec3 center(0.3, -0.2, 1.1);
    const auto sphere = makeSphere(center, 0.8);
    const auto box = makeBox({-1.0, 0.5, 0.0}, {0.5, 0.9, 0.25});
    const auto torus = makeTorus(1.0, 0.4);
    for (const Encoding& e : kOrthographic) {
        votes.expect(*sphere, centeredFrame(center, glm::dmat3(1.0), {2.0, 2.0, 2.0}), e);
        votes.expect(*sphere, centeredFrame(center + 0.05, kTurned, {1.9, 2.4, 3.0}), e);
        votes.expect(*box, centeredFrame({-1.0, 0.5, 0.0}, kTurned, {2.5, 2.25, 2.5}), e);
        votes.expect(*torus, centeredFrame({0.01, 0.02, 0.0}, rotation({0, 0, 1}, 25.0), {3.2, 3.3, 1.0}), e);
    }
}

TEST(PlaneDecode, AMirroredFrameVotesTheSame) {
    // The map's x axis the other way round: columns swap, distances stay.
    const auto sphere = makeSphere({0, 0, 0}, 0.8);
    const OrthographicFrame frame = centeredFrame({0.1, 0, 0}, kTurned, {2.0, 2.5, 3.0});
    DepthMap map = makeMap(*sphere, frame, MapFormat::kFixed8, Compare::kLess, 12, 10);
    map.decode = Decode::kPlane;
    DepthMap mirrored = map;
    mirrored.object_to_map.row[0] *= -1.0F;
    mirrored.object_to_map.row[0].w += 1.0F;
    for (std::uint32_t y = 0; y < map.height; ++y) {
        for (std::uint32_t x = 0; x < map.width; ++x) {
            std::ranges::copy(map.texelAt(0, x, y), mirrored.texelAt(0, map.width - 1 - x, y).begin());
        }
    }
    ASSERT_TRUE(validateFrame(mirrored));
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(0.1, 0.9);
    for (int i = 0; i < 5000; ++i) {
        const glm::vec3 p(frame.toObject({unit(random), unit(random), unit(random)}));
        const std::optional<Vote> a = vote(map, p);
        const std::optional<Vote> b = vote(mirrored, p);
        ASSERT_TRUE(a && b);
        if (a->normal == b->normal) {  // not at a texel's border
            ASSERT_NEAR(a->distance, b->distance, 2e-6F);
        }
    }
}

TEST(PlaneDecode, CubesFromWithinAConvexShapeAndFromTheHoleOfATorus) {
    PlaneVotes votes;
    for (const CubeFrame& frame : {CubeFrame{{0.1, 0.2, -0.3}, glm::dmat3(1.0), {1.0, 1.0, 1.0}},
                                   CubeFrame{{0.1, 0.2, -0.3}, kTurned, {1.0, 1.7, 1.25}}}) {
        votes.expect(*makeSphere({0.2, 0.1, -0.2}, 0.75), frame, Compare::kGreater);
        votes.expect(*makeBox({0.15, 0.2, -0.25}, {0.4, 0.5, 0.3}), frame, Compare::kGreater);
    }
    const auto torus = makeTorus(1.0, 0.6);
    votes.expect(*torus, {{0, 0, 0}, glm::dmat3(1.0), {1.7, 1.7, 1.0}}, Compare::kLess);
    votes.expect(*torus, {{0, 0, 0}, rotation({1, 1, 0}, 50.0), {2.0, 1.8, 1.7}}, Compare::kLess);
}

TEST(PlaneDecode, SignsFromTheHoleOfATorus) {
    // Outside in the hole, inside behind the surface: the normal points to the centre there.
    const auto torus = makeTorus(1.0, 0.4);
    DepthMap map = makeMap(*torus, CubeFrame{{0, 0, 0}, kTurned, glm::dvec3(1.8)}, Compare::kLess, 64);
    map.decode = Decode::kPlane;
    for (double angle = 0.0; angle < 6.28; angle += 0.1) {
        const glm::dvec3 out(std::cos(angle), std::sin(angle), 0.0);
        for (const double radius : {0.1, 0.3, 0.5, 0.59, 0.61, 0.7, 0.9}) {
            const std::optional<Vote> got = vote(map, glm::vec3(radius * out));
            ASSERT_TRUE(got);
            ASSERT_NEAR(got->distance, 0.6 - radius, 0.02) << radius;
            ASSERT_EQ(got->distance < 0.0F, torus->inside(radius * out)) << radius;
        }
    }
}

TEST(PlaneDecode, AnObliqueHalfSpaceIsExactForAnyPoint) {
    // Normals that the index holds exactly leave the depth's quantum alone, and that only as far as the plane
    // faces the ray.
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const OrthographicFrame frame = centeredFrame({2.0, -1.0, 0.5}, kTurned, {1.0, 1.3, 9.0});
    for (const Encoding& encoding : kOrthographic) {
        if (encoding.compare == Compare::kBoth) {
            continue;  // a half-space has one surface; see the slab
        }
        SCOPED_TRACE(nameOf(encoding));
        int oblique = 0;
        for (int repeat = 0; repeat < 200; ++repeat) {
            const NormalIndex index{static_cast<std::uint8_t>(random() % 255),
                                    static_cast<std::uint8_t>(random() % 255)};
            const glm::dvec3 normal = glm::normalize(glm::dvec3(decodeNormal(index)));
            const double cosine = glm::dot(normal, frame.axes[2]);
            if (encoding.compare == Compare::kLess ? cosine > -0.2 : cosine < 0.2) {
                continue;
            }
            oblique += std::abs(cosine) < 0.5 ? 1 : 0;
            const double plane = glm::dot(normal, frame.toObject({0.5, 0.5, 0.5}));
            DepthMap map =
                makeMap(*makeHalfSpace(normal, plane), frame, encoding.format, encoding.compare, 9, 8);
            map.decode = Decode::kPlane;
            for (int i = 0; i < 500; ++i) {
                const glm::vec3 p(frame.toObject(
                    {0.125 + 0.75 * unit(random), 0.1251 + 0.7498 * unit(random), unit(random)}));
                const double bound = std::abs(cosine) * frame.sides.z * depthQuantum(encoding.format, 1.0) +
                                     roundingSlack(map, p, 12.0);
                const std::optional<Vote> got = vote(map, p);
                ASSERT_TRUE(got);
                ASSERT_NEAR(got->distance, glm::dot(normal, glm::dvec3(p)) - plane, bound) << cosine;
            }
        }
        EXPECT_GT(oblique, 10);
    }
}

/// Fills a map with one standing plane a texel and checks the votes of points anywhere along each texel's
/// ray.
void expectStandingPlanes(DepthMap map, const std::vector<glm::dvec3>& normals) {
    map.decode = Decode::kPlane;
    const bool cube = map.projection() == Projection::kCube;
    const double depth_max = cube ? double{kCubeDepthMax} : 1.0;
    const double range = standingRange(map.projection(), map.object_per_map, map.width, map.height);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0.01, 0.99);
    int checked = 0;
    for (std::uint32_t face = 0; face < map.faceCount(); ++face) {
        for (std::uint32_t y = 1; y + 1 < map.height; ++y) {
            for (std::uint32_t x = 1; x + 1 < map.width; ++x) {
                const TexelRay ray = texelRay(map, face, x, y);
                glm::dvec3 normal(0.0);
                for (int tries = 0; tries < 20'000 && normal == glm::dvec3(0.0); ++tries) {
                    const glm::dvec3& candidate = normals[random() % normals.size()];
                    const double cosine = glm::dot(candidate, glm::normalize(ray.direction));
                    normal = std::abs(cosine) < kStandingCosine - 1e-4 ? candidate : normal;
                }
                ASSERT_NE(normal, glm::dvec3(0.0));
                const double depth = depth_max * unit(random);
                const double offset = (2.0 * depth / depth_max - 1.0) * range;
                const Surface surface{static_cast<float>(depth), glm::vec3(normal)};
                encodeTexel(map.format,
                            {surface, isFrontBack(map.format) ? std::optional(surface) : std::nullopt},
                            map.texelAt(face, x, y));
                for (int i = 0; i < 20; ++i) {
                    // The middle half of the texel about its ray.
                    glm::dvec3 p = ray.at(depth_max * unit(random) * (cube ? 0.55 : 1.0));
                    if (cube) {
                        p = ray.origin + (p - ray.origin) * unit(random);
                    }
                    const std::optional<Vote> got = vote(map, glm::vec3(p));
                    ASSERT_TRUE(got);
                    const double bound = 2.0 * range * depthQuantum(map.format, depth) / depth_max +
                                         roundingSlack(map, glm::vec3(p), 12.0);
                    ASSERT_NEAR(got->distance, glm::dot(normal, p - ray.origin) - offset, bound);
                    ++checked;
                }
            }
        }
    }
    EXPECT_GT(checked, 500);
}

TEST(PlaneDecode, AStandingPlaneIsExactAllAlongTheRay) {
    std::vector<glm::dvec3> normals;
    for (std::uint32_t s = 0; s < 255; ++s) {
        for (std::uint32_t t = 0; t < 255; ++t) {
            normals.emplace_back(decodeNormal({static_cast<std::uint8_t>(s), static_cast<std::uint8_t>(t)}));
        }
    }
    const auto sphere = makeSphere({0, 0, 0}, 0.5);
    for (const Encoding& e : kOrthographic) {
        SCOPED_TRACE(nameOf(e));
        for (const glm::dmat3& axes : {glm::dmat3(1.0), kTurned}) {
            const OrthographicFrame frame = centeredFrame({0.1, 0.2, 0.3}, axes, {2.0, 1.0, 3.0});
            expectStandingPlanes(makeMap(*sphere, frame, e.format, e.compare, 9, 8), normals);
        }
    }
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        expectStandingPlanes(makeMap(*sphere, CubeFrame{{0, 0, 0}, kTurned, {1.0, 1.7, 1.25}}, compare, 9),
                             normals);
    }
}

TEST(PlaneDecode, AnObliqueSlabIsExactForAnyPoint) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> unit(0.13, 0.87);
    const auto slab = makeBox({0, 0, 0}, {50.0, 50.0, 0.3});
    for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
        const OrthographicFrame frame =
            centeredFrame({0, 0, 0.1}, rotation({1.0, 0.5, 0.0}, degrees), {1.0, 1.0, 12.0});
        const double cosine = std::abs(frame.axes[2].z);
        for (const MapFormat format : {MapFormat::kFrontBackHalf, MapFormat::kFrontBackFixed}) {
            SCOPED_TRACE(depthEncodingName(format));
            DepthMap map = makeMap(*slab, frame, format, Compare::kBoth, 8, 8);
            map.decode = Decode::kPlane;
            for (int i = 0; i < 5000; ++i) {
                const glm::vec3 p(frame.toObject({unit(random), unit(random), unit(random)}));
                const std::optional<Vote> got = vote(map, p);
                ASSERT_TRUE(got);
                ASSERT_NEAR(got->distance, std::abs(static_cast<double>(p.z)) - 0.3,
                            cosine * frame.sides.z * depthQuantum(format, 1.0) + roundingSlack(map, p, 12.0));
            }
        }
    }
}

/// Looks along the axes of `turn`. The window leaves three texels around a ball of radius `half`.
Collider threeMaps(const Shape& shape, const glm::dmat3& turn, double half, std::uint32_t size,
                   MapFormat format, Decode decode) {
    Collider collider;
    const double side = 2.0 * half * size / (size - 6);
    const glm::dmat3 looks[] = {{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
                                {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
                                {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (const glm::dmat3& axes : looks) {
        collider.maps.push_back(makeMap(shape, centeredFrame({0, 0, 0}, turn * axes, glm::dvec3(side)),
                                        format, Compare::kBoth, size, size));
        collider.maps.back().decode = decode;
    }
    return collider;
}

TEST(PlaneDecode, BoxFacesAreExactAwayFromTheEdges) {
    const glm::dvec3 half(0.7, 0.5, 0.6);
    constexpr std::uint32_t kSize = 80;
    constexpr double kRadius = 1.1;
    // Every map sees every face by a cosine of at least 1/3.
    const glm::dmat3 turn = rotation({1, 1, 1}, 60.0);
    const Collider collider = threeMaps(*makeBox({0, 0, 0}, half), turn, kRadius, kSize,
                                        MapFormat::kFrontBackFixed, Decode::kPlane);
    const double side = 2.0 * kRadius * kSize / (kSize - 6);
    const double bound = side * depthQuantum(MapFormat::kFrontBackFixed, 1.0) + 4e-6;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int outside = 0;
    for (int i = 0; i < 60'000; ++i) {
        // Near a face: a ray half a texel's diagonal aside meets it (0.03 + 0.02)/⅓ along, within the margin.
        const auto axis = static_cast<int>(random() % 3);
        const double height = 0.03 * unit(random);
        const double margin = 0.2;
        glm::dvec3 at;
        for (int k = 0; k < 3; ++k) {
            at[k] = (half[k] - margin) * unit(random);
        }
        at[axis] = (random() % 2 == 0 ? 1.0 : -1.0) * (half[axis] + height);
        const glm::vec3 p(at);
        const double expected = std::abs(static_cast<double>(p[axis])) - half[axis];
        const FieldSample sample = evaluate(collider, p);
        ASSERT_GE(sample.map, 0);
        ASSERT_NEAR(sample.distance, expected, bound) << axis << " " << height;
        outside += expected > 0.0 ? 1 : 0;
    }
    EXPECT_NEAR(outside, 30'000, 2'000);
}

TEST(PlaneDecode, OnASphereTheErrorIsOfSecondOrderInTheTexelSize) {
    // On the sphere itself, |n·(P − S)| = |P − S|²/2R: exact, and a quarter for half the texel. The paper's
    // decode halves.
    constexpr double kRadius = 1.0;
    const auto sphere = makeSphere({0, 0, 0}, kRadius);
    const OrthographicFrame frame = centeredFrame({0, 0, 0}, kTurned, glm::dvec3(2.4));
    double before[2] = {0.0, 0.0};
    for (const std::uint32_t size : {32U, 64U, 128U, 256U}) {
        double mean[2] = {0.0, 0.0};
        for (const Decode decode : {Decode::kPlane, Decode::kProjected}) {
            DepthMap map = makeMap(*sphere, frame, MapFormat::kFloat32, Compare::kLess, size, size);
            map.decode = decode;
            const double texel = frame.sides.x / size;
            std::mt19937 random(12);
            std::uniform_real_distribution<double> within(-0.7, 0.7);
            constexpr int kCount = 20'000;
            for (int i = 0; i < kCount;) {
                const glm::dvec2 across(within(random), within(random));
                if (glm::length(across) > 0.7) {
                    continue;  // a texel there may miss the sphere
                }
                ++i;
                const double z = -std::sqrt(kRadius * kRadius - glm::dot(across, across));
                const glm::vec3 p(frame.axes * glm::dvec3(across, z));
                const double error = std::abs(static_cast<double>(vote(map, p)->distance));
                if (decode == Decode::kPlane) {
                    // |P − S| is at most half a texel's diagonal over the smallest cosine that it crosses.
                    const double half_diagonal = std::sqrt(0.5) * texel;
                    const double farthest = 0.7 + half_diagonal;
                    const double chord = half_diagonal / std::sqrt(1.0 - farthest * farthest);
                    ASSERT_LE(error, chord * chord / (2.0 * kRadius) + 2e-6);
                }
                mean[decode == Decode::kPlane ? 0 : 1] += error / kCount;
            }
        }
        if (before[0] > 0.0) {
            EXPECT_NEAR(before[0] / mean[0], 4.0, 0.4) << size;
            EXPECT_NEAR(before[1] / mean[1], 2.0, 0.1) << size;
        }
        before[0] = mean[0];
        before[1] = mean[1];
    }
}

TEST(PlaneDecode, NearASphereTheDistanceIsFiveTimesBetterThanProjected) {
    constexpr double kRadius = 0.9;
    const auto sphere = makeSphere({0, 0, 0}, kRadius);
    for (const MapFormat format : {MapFormat::kFrontBackHalf, MapFormat::kFrontBackFixed}) {
        double mean[2] = {0.0, 0.0};
        double wrong[2] = {0.0, 0.0};
        for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
            const auto at = static_cast<std::size_t>(decode);
            const Collider collider = threeMaps(*sphere, glm::dmat3(1.0), kRadius, 64, format, decode);
            std::mt19937 random(14);
            std::normal_distribution<double> gauss;
            constexpr int kCount = 100'000;
            int counted = 0;
            for (int i = 0; i < kCount; ++i) {
                const glm::dvec3 direction =
                    glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
                const glm::vec3 p((kRadius + 0.01 * gauss(random)) * direction);
                const double truth = glm::length(glm::dvec3(p)) - kRadius;
                const FieldSample sample = evaluate(collider, p);
                ASSERT_GE(sample.map, 0);
                wrong[at] += sample.inside() != (truth < 0.0) ? 1.0 / kCount : 0.0;
                if (sample.distance < kFarOutside) {
                    mean[at] += std::abs(static_cast<double>(sample.distance) - truth);
                    ++counted;
                }
            }
            mean[at] /= counted;
            ASSERT_GT(counted, kCount / 2);
        }
        RecordProperty(std::string("mean_projected_") + depthEncodingName(format), std::to_string(mean[0]));
        RecordProperty(std::string("mean_plane_") + depthEncodingName(format), std::to_string(mean[1]));
        RecordProperty(std::string("wrong_projected_") + depthEncodingName(format), std::to_string(wrong[0]));
        RecordProperty(std::string("wrong_plane_") + depthEncodingName(format), std::to_string(wrong[1]));
        EXPECT_LT(5.0 * mean[1], mean[0]) << mean[0] << " " << mean[1];
        EXPECT_LT(2.0 * wrong[1], wrong[0]) << wrong[0] << " " << wrong[1];
    }
}

// ---- the rest of the vote is the projected one's
// ---------------------------------------------------------------

TEST(PlaneDecode, VolumeWindowAndEmptyTexelsAreThoseOfProjected) {
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
                // Step 5: an enclosing map says inside in its volume only.
                const glm::vec3 in_map = map.object_to_map.apply(p);
                const float low = map.projection() == Projection::kCube ? -1.0F : 0.0F;
                const auto beyond = [&](float v) { return v < low || v > 1.0F; };
                if (beyond(in_map.x) || beyond(in_map.y) || beyond(in_map.z)) {
                    ASSERT_GE(plane->distance, 0.0F);
                }
            }
        }
    }
    EXPECT_GT(same, 1000);
}

TEST(PlaneDecode, NoFinitePointGivesNaNAndFarOnesAreOutside) {
    constexpr float kMax = std::numeric_limits<float>::max();
    Collider collider;
    for (const Encoding& e : kOrthographic) {
        for (const double scale : {1e-15, 1.0, 1e15}) {
            collider.maps.push_back(makeMap(*makeSphere({0, 0, 0}, 1.0),
                                            centeredFrame({0, 0, 0}, kTurned, {2.5, 2.5 * scale, 2.5}),
                                            e.format, e.compare, 12, 12));
        }
    }
    for (const Compare compare : {Compare::kLess, Compare::kGreater}) {
        collider.maps.push_back(makeMap(*makeSphere({0, 0, 0}, 1.0),
                                        CubeFrame{{0, 0, 0}, kTurned, {2.0, 1e-3, 2.0}}, compare, 4));
    }
    for (DepthMap& map : collider.maps) {
        map.decode = Decode::kPlane;
    }
    const float values[] = {0.0F, 1e-40F, -1e4F, 3e9F, -1e15F, 1e19F, -1e30F, kMax, -kMax};
    for (const float x : values) {
        for (const float y : values) {
            for (const float z : values) {
                const glm::vec3 p(x, y, z);
                for (const DepthMap& map : collider.maps) {
                    const std::optional<Vote> got = vote(map, p);
                    ASSERT_TRUE(got);
                    ASSERT_FALSE(std::isnan(got->distance)) << x << " " << y << " " << z;
                    ASSERT_FALSE(std::isnan(got->normal.x + got->normal.y + got->normal.z));
                }
                const FieldSample sample = evaluate(collider, p);
                const bool far = std::max({std::abs(x), std::abs(y), std::abs(z)}) > 10.0F;
                ASSERT_TRUE(!far || !sample.inside()) << x << " " << y << " " << z;
                ASSERT_EQ(evaluateInside(collider, p).inside, sample.inside());
            }
        }
    }
}

// ---- for writers
// -----------------------------------------------------------------------------------------------

TEST(TexelRay, IsTheFramesOwn) {
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

TEST(TexelRay, MeetsThePlaneThatTheReaderSees) {
    // A plane through a point Q aside of the ray, stored at planeDepth: the reader's f is 0 at Q.
    std::mt19937 random(4);
    std::normal_distribution<double> gauss;
    DepthMap map = emptyMap(centeredFrame({2.0, -1.0, 0.5}, kTurned, {3.0, 1.0, 0.75}), MapFormat::kFloat32,
                            Compare::kLess, 9, 5);
    map.decode = Decode::kPlane;
    DepthMap cube = emptyMap(CubeFrame{{2.0, -1.0, 0.5}, kTurned, {3.0, 1.0, 0.75}}, Compare::kLess, 7);
    cube.decode = Decode::kPlane;
    int checked = 0;
    for (int i = 0; i < 2000; ++i) {
        for (DepthMap* each : {&map, &cube}) {
            const auto face = static_cast<std::uint32_t>(random() % each->faceCount());
            const TexelRay ray = texelRay(*each, face, 3, 2);
            const TexelRay beside = {ray.origin, texelRay(*each, face, 4, 2).direction};
            const glm::dvec3 q = each == &map
                                     ? ray.at(0.5) + 0.1 * (texelRay(map, 0, 4, 2).origin - ray.origin)
                                     : 0.9 * ray.at(0.8) + 0.1 * beside.at(0.8);
            const glm::dvec3 normal = storedNormal(
                each->format,
                turnedToViewer(glm::dvec3(gauss(random), gauss(random), gauss(random)), -ray.direction));
            const double depth = planeDepth(ray, normal, q);
            if (!(depth > 0.0 && depth < 1.0)) {
                continue;
            }
            encodeTexel(each->format, {Surface{static_cast<float>(depth), glm::vec3(normal)}, std::nullopt},
                        each->texelAt(face, 3, 2));
            const std::optional<Vote> got = vote(*each, glm::vec3(q));
            ASSERT_TRUE(got);
            ASSERT_NEAR(got->distance, 0.0, 3.0 * depthQuantum(each->format, depth) + 3e-6);
            ++checked;
        }
    }
    EXPECT_GT(checked, 2000);
}

TEST(Grazing, ATurnedNormalKeepsItsAngleToTheRayWhenStored) {
    std::mt19937 random(21);
    std::normal_distribution<double> gauss;
    const auto direction = [&] {
        return glm::normalize(glm::dvec3(gauss(random), gauss(random), gauss(random)));
    };
    double worst = 0.0;
    for (int i = 0; i < 200'000; ++i) {
        const glm::dvec3 viewer = direction();
        glm::dvec3 normal = direction();
        if (i % 2 == 0) {  // grazing
            normal = glm::normalize(normal - (glm::dot(normal, viewer) - 0.04 * gauss(random)) * viewer);
        }
        const glm::dvec3 turned = turnedToViewer(3.0 * normal, 5.0 * viewer);
        ASSERT_NEAR(glm::length(turned), 1.0, 1e-12);
        const glm::dvec3 stored = storedNormal(MapFormat::kFixed8, turned);
        worst = std::max(worst, glm::length(stored - turned));
        ASSERT_GE(glm::dot(stored, viewer), kPlaneGrazingMin);
        if (glm::dot(normal, viewer) > kPlaneGrazingMin + kNormalIndexError) {
            ASSERT_LT(glm::length(turned - normal), 1e-12);
        } else {  // no farther than needed: in the plane of both
            ASSERT_NEAR(glm::dot(turned, glm::cross(normal, viewer)), 0.0, 1e-9);
            ASSERT_GT(glm::dot(turned, normal - glm::dot(normal, viewer) * viewer), 0.0);
        }
    }
    EXPECT_LE(worst, kNormalIndexError);
    EXPECT_GT(worst, 0.9 * kNormalIndexError) << "the bound is not what the index needs";
    for (const glm::dvec3& away : {glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)}) {
        EXPECT_EQ(turnedToViewer(away, {0, 0, -2}), glm::dvec3(0, 0, -1));
    }
}

}  // namespace
}  // namespace relief
