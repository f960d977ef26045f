// Inside a thick plate the face that is nearer decides, and its normal is exact, however the plate is turned.
#include "bake/patches/depth_planes.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <random>

#include "bake/patches/patch_planner.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

/// A plate of 10 by 1 by 10, turned about z, baked at so many bytes.
struct Plate {
    static constexpr double kHalf = 5.0;
    static constexpr double kBesideEdges = 0.8;

    Plate(double degrees, std::uint64_t bytes)
        : turn(glm::angleAxis(glm::radians(degrees), glm::dvec3(0.0, 0.0, 1.0))),
          map(bakePatches(queryOf(makeBoxMesh(glm::dvec3(0.0), {kHalf, 0.5, kHalf}, glm::mat3_cast(turn))),
                          {.bytes = bytes})
                  ->map) {
        EXPECT_TRUE(validateFrame(map) && validateTexels(map));
        EXPECT_LE(map.texels.size(), bytes);
    }

    struct Point {
        glm::vec3 position;
        double depth;
        glm::dvec3 normal;
    };
    /// A point so deep below the top or the bottom.
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

class PlateTest : public testing::TestWithParam<int> {};

TEST_P(PlateTest, TheNearerFaceDecides) {
    for (const std::uint64_t bytes : {128'000U, 256'000U}) {
        SCOPED_TRACE(bytes);
        const Plate plate(GetParam(), bytes);
        std::mt19937 random(7);
        double turned = 0.0;
        double off = 0.0;
        for (int i = 0; i < 5000; ++i) {
            const Plate::Point point = plate.pointAt(random, 0.005, 0.4);
            const std::optional<Vote> found = vote(plate.map, point.position);
            turned = std::max(turned, degreesBetween(found->normal, point.normal));
            off = std::max(off, std::abs(double{found->distance} + point.depth));
        }
        EXPECT_LT(turned, 1.0);
        EXPECT_LT(off, 0.01);
    }
}

TEST_P(PlateTest, PointsBesideAFaceHaveItsSideAndItsNormal) {
    const Plate plate(GetParam(), 512'000);
    std::mt19937 random(9);
    double turned = 0.0;
    int wrong = 0;
    for (int i = 0; i < 5000; ++i) {
        const Plate::Point point = plate.pointAt(random, -0.05, 0.05);
        const std::optional<Vote> found = vote(plate.map, point.position);
        wrong += std::abs(point.depth) > 1e-3 && (found->distance < 0.0F) != (point.depth > 0.0) ? 1 : 0;
        if (found->distance < 0.0F) {
            turned = std::max(turned, degreesBetween(found->normal, point.normal));
        }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_LT(turned, 1.0);
}

INSTANTIATE_TEST_SUITE_P(Degrees, PlateTest, testing::Values(0, 20, 30, 45, 60));

}  // namespace
}  // namespace relief::test
