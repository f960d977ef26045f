// SPDX-License-Identifier: Apache-2.0
// Inside a thick plate the nearer face decides and has an exact normal, for every rotation of the plate.
#include "bake/patches/depth_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>
#include <utility>
#include <vector>

#include "bake/patches/patch_planner.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

/// A plate of 10 by 1 by 10, rotated about z and baked into this many bytes.
struct Plate {
    static constexpr double kHalf = 5.0;
    static constexpr double kBesideEdges = 0.8;

    Plate(double degrees, std::uint64_t bytes) : Plate(degrees, bytes, boxFromTo(-kHalf, kHalf, degrees)) {}
    /// \param mesh  another mesh of the same solid
    Plate(double degrees, std::uint64_t bytes, PreparedMesh mesh)
        : turn(turnBy(degrees)), map(bakePatches(queryOf(std::move(mesh)), {.bytes = bytes})->map) {
        EXPECT_TRUE(validateFrame(map) && validateTexels(map));
        EXPECT_LE(map.texels.size(), bytes);
    }

    static glm::dquat turnBy(double degrees) {
        return glm::angleAxis(glm::radians(degrees), glm::dvec3(0.0, 0.0, 1.0));
    }
    /// The part of the plate between these x coordinates.
    static TriangleMesh boxFromTo(double low, double high, double degrees) {
        const glm::dquat turn = turnBy(degrees);
        return makeBoxMesh(turn * glm::dvec3(0.5 * (low + high), 0.0, 0.0), {0.5 * (high - low), 0.5, kHalf},
                           glm::mat3_cast(turn));
    }

    struct Point {
        glm::vec3 position;
        double depth;
        glm::dvec3 normal;
    };
    /// A point at a depth of `least` to `most` below the top or the bottom.
    template <class Random>
    [[nodiscard]] Point pointAt(Random& random, double least, double most) const {
        const auto uniform = [&](double low, double high) {
            return low + (high - low) * (static_cast<double>(random()) * std::ldexp(1.0, -32));
        };
        const double up = random() % 2 == 0 ? 1.0 : -1.0;
        const double depth = uniform(least, most);
        const double x = uniform(kBesideEdges - kHalf, kHalf - kBesideEdges);
        const double z = uniform(kBesideEdges - kHalf, kHalf - kBesideEdges);
        return {glm::vec3(turn * glm::dvec3(x, up * (0.5 - depth), z)), depth,
                turn * glm::dvec3(0.0, up, 0.0)};
    }

    glm::dquat turn;
    DepthMap map;
};

double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return glm::degrees(std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)));
}

/// \param beside  minimum distance from the plate's plane x = 0
void expectNearerFace(const Plate& plate, double beside = 0.0) {
    std::mt19937 random(7);
    double turned = 0.0;
    double off = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const Plate::Point point = plate.pointAt(random, 0.005, 0.45);
        const Vote found = vote(plate.map, point.position).value();
        ASSERT_LT(found.distance, 0.0F);
        if (std::abs((glm::conjugate(plate.turn) * glm::dvec3(point.position)).x) < beside) {
            continue;
        }
        turned = std::max(turned, degreesBetween(found.normal, point.normal));
        off = std::max(off, std::abs(double{found.distance} + point.depth));
    }
    EXPECT_LT(turned, 1.0);
    EXPECT_LT(off, 0.01);
}

class PlateTest : public testing::TestWithParam<int> {};

TEST_P(PlateTest, NearerFaceDecides) {
    for (const std::uint64_t bytes : {64'000U, 256'000U}) {
        SCOPED_TRACE(bytes);
        expectNearerFace(Plate(GetParam(), bytes));
    }
}

TEST_P(PlateTest, PointsBesideAFaceHaveItsSideAndNormal) {
    const Plate plate(GetParam(), 512'000);
    std::mt19937 random(9);
    double turned = 0.0;
    int wrong = 0;
    for (int i = 0; i < 5000; ++i) {
        const Plate::Point point = plate.pointAt(random, -0.05, 0.05);
        const Vote found = vote(plate.map, point.position).value();
        wrong += std::abs(point.depth) > 1e-3 && (found.distance < 0.0F) != (point.depth > 0.0) ? 1 : 0;
        if (found.distance < kFarOutside) {  // otherwise outside the volume of the map
            turned = std::max(turned, degreesBetween(found.normal, point.normal));
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_LT(turned, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Degrees, PlateTest, testing::Values(0, 20, 35, 50, 60));

// A former bug: octants beside a face had the coarse normal of their split parent cell, with errors up to 1.6 degrees.
TEST(DepthPlanes, FlatFacesHaveExactNormalsOnBothSides) {
    const glm::dquat turn = glm::angleAxis(0.7, glm::normalize(glm::dvec3(1.0, 2.0, 3.0)));
    const glm::dvec3 half(5.0, 1.5, 5.0);
    const DepthMap map =
        bakePatches(queryOf(makeBoxMesh(glm::dvec3(0.0), half, glm::mat3_cast(turn))), {.bytes = 512'000})
            ->map;
    std::mt19937 random(9);
    const auto uniform = [&](double most) {
        return most * (std::ldexp(static_cast<double>(random()), -31) - 1.0);
    };
    double turned = 0.0;
    for (int i = 0; i < 5000; ++i) {
        const int axis = i % 3;
        glm::dvec3 normal(0.0);
        normal[axis] = random() % 2 == 0 ? 1.0 : -1.0;
        glm::dvec3 point = glm::dvec3(uniform(half.x - 0.8), uniform(half.y - 0.8), uniform(half.z - 0.8));
        point[axis] = normal[axis] * (half[axis] + uniform(0.05));
        const std::optional<Vote> found = vote(map, glm::vec3(turn * point));
        ASSERT_TRUE(found);
        turned = std::max(turned, degreesBetween(found->normal, turn * normal));
    }
    EXPECT_LT(turned, 1.0);
}

TEST(DepthPlanes, LargeBudgetsAreExact) {
    expectNearerFace(Plate(30.0, 1'000'000));
}

TEST(DepthPlanes, WindingDoesNotMatter) {
    TriangleMesh mesh = Plate::boxFromTo(-Plate::kHalf, Plate::kHalf, 30.0);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
        std::swap(mesh.triangles[i].y, mesh.triangles[i].z);
    }
    expectNearerFace(Plate(30.0, 128'000, finished(mesh.positions, mesh.triangles)));
}

// The ends of two overlapping boxes are inside the plate that they form, and are not part of its surface. Near them all
// samples of a cell are dropped, so the cell has no depth planes.
TEST(DepthPlanes, FacesInsideOtherSolidsAreIgnored) {
    const TriangleMesh two =
        joined({Plate::boxFromTo(-Plate::kHalf, 0.5, 30.0), Plate::boxFromTo(-0.5, Plate::kHalf, 30.0)});
    const std::vector<std::uint32_t> by_winding(two.triangles.size(), 0);
    expectNearerFace(Plate(30.0, 128'000, PreparedMesh::unionOf(two, by_winding)), 1.0);
}

TEST(MeanPlane, EmptySetGivesTheMiddle) {
    const CellPlane plane = meanPlane(std::vector<ClippedTriangle>(2));
    EXPECT_EQ(plane.offset, 0.0);
    EXPECT_EQ(glm::length(plane.normal), 1.0);
}

}  // namespace
}  // namespace relief::test
