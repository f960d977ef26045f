// SPDX-License-Identifier: Apache-2.0
// The worst places compared with closed forms: corrupted maps, unseen surface, details finer than a texel, occluded
// parts, sheets and open meshes.
#include "bake/measure/worst_places.h"

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "tests/bake/meshes.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

constexpr const char* kPlanes = ",decode=plane,depth=unorm16";

struct Measured {
    std::vector<WorstPlace> places;
    double unseen_percent = 0.0;
};

Measured measuredPlaces(const TriangleMesh& mesh, const Collider& collider, std::uint32_t samples = 40'000) {
    const MeshQuery query = required(MeshQuery::build(mesh));
    const TruthSamples truth = sampleTruth(query, {.samples = samples});
    const Sights sights(collider.maps, query);
    return {worstPlaces(truth, query, sights, collider), sights.unseenPercent(truth.surface)};
}

std::vector<std::string> threeViews(const std::string& size) {
    std::vector<std::string> specs;
    for (const char* axis : {"x", "y", "z"}) {
        specs.push_back(std::string("front-back:dir=-") + axis + ",size=" + size + kPlanes);
    }
    return specs;
}

TEST(WorstPlaces, AreWhereAMapIsCorrupted) {
    const TriangleMesh sphere = makeIcosphere({1, 2, 3}, 1.0, 5);
    Collider collider = bakeSpecs(sphere, threeViews("64"));
    const Measured sound = measuredPlaces(sphere, collider);
    // Clears a block of 10 × 10 texels in the map along y, where the sphere covers 62 texels. The map reports outside
    // there, at both ends.
    DepthMap& map = collider.maps[1];
    for (std::uint32_t y = 20; y < 30; ++y) {
        for (std::uint32_t x = 36; x < 46; ++x) {
            const std::span<std::byte> texel = map.texelAt(0, x, y);
            std::memcpy(texel.data(), map.texelAt(0, 0, 0).data(), texel.size());
        }
    }
    const Measured found = measuredPlaces(sphere, collider);
    ASSERT_GE(found.places.size(), 2U);
    // The map looks down: x is right and −z is up.
    const double texel = 2.0 / 62.0;
    const double x = 1.0 + texel * (41.0 - 32.0);
    const double z = 3.0 - texel * (25.0 - 32.0);
    const double height = std::sqrt(1.0 - (x - 1.0) * (x - 1.0) - (z - 3.0) * (z - 3.0));
    bool above = false;
    bool below = false;
    for (std::size_t i = 0; i < 2; ++i) {
        const WorstPlace& place = found.places[i];
        EXPECT_EQ(place.map, 1);
        EXPECT_GT(place.map_percent, 95.0);
        EXPECT_EQ(place.cause, WrongCause::kTexel) << wordOf(place.cause);
        EXPECT_LT(place.false_inside_percent, 5.0);
        EXPECT_NEAR(place.texel, texel, 1e-4);
        EXPECT_NEAR(double{place.position.x}, x, 5.0 * texel);
        EXPECT_NEAR(double{place.position.z}, z, 5.0 * texel);
        EXPECT_NEAR(std::abs(double{place.position.y} - 2.0), height, 0.12);
        EXPECT_NEAR(place.size(), 10.0 * texel, 2.5 * texel);
        (place.position.y > 2.0F ? above : below) = true;
        // The block covers 0.83 % of the sphere. About half of the points near it are inside.
        EXPECT_GT(static_cast<double>(place.points), 0.3 * 40'000 * 0.0083);
        EXPECT_GT(static_cast<double>(place.points),
                  5.0 * static_cast<double>(sound.places.empty() ? 0 : sound.places[0].points));
    }
    EXPECT_TRUE(above && below);
    EXPECT_GT(found.places[0].contribution_percent + found.places[1].contribution_percent, 30.0);
}

TEST(WorstPlaces, CoarseMapsCauseTexelErrorsDeterministically) {
    const TriangleMesh torus = makeTorusMesh(1.0, 0.3, 128, 64);
    const Collider collider = bakeSpecs(torus, threeViews("12"));
    const Measured found = measuredPlaces(torus, collider);
    const Measured single = onThreads(1, [&] { return measuredPlaces(torus, collider); });
    ASSERT_EQ(found.places.size(), 3U);
    ASSERT_EQ(single.places.size(), 3U);
    std::uint64_t before = ~std::uint64_t{0};
    for (std::size_t i = 0; i < 3; ++i) {
        const WorstPlace& place = found.places[i];
        EXPECT_EQ(place.cause, WrongCause::kTexel) << wordOf(place.cause);
        ASSERT_GE(place.map, 0);
        EXPECT_GT(place.texel, 0.05);
        EXPECT_GT(place.size(), 0.0);
        EXPECT_LT(place.size(), 0.25 * 2.6);
        EXPECT_LE(place.points, before);
        before = place.points;
        EXPECT_EQ(place.position, single.places[i].position);
        EXPECT_EQ(place.points, single.places[i].points);
    }
}

TEST(WorstPlaces, UnseenCavityIsFixedByACube) {
    const TriangleMesh mesh = joined({makeBoxMesh({0, 0, 0}, {1, 1, 1}), makeIcosphere({0.2, 0, 0}, 0.5, 4)});
    std::vector<std::string> specs = threeViews("32");
    const Measured found = measuredPlaces(mesh, bakeSpecs(mesh, specs));
    ASSERT_EQ(found.places.size(), 3U);
    for (const WorstPlace& place : found.places) {
        EXPECT_EQ(place.cause, WrongCause::kUnseen) << wordOf(place.cause);
        // The exceptions are texels fitted to the cavity, which are wrong in front of it.
        EXPECT_GT(place.false_inside_percent, 60.0);
        EXPECT_NEAR(double{glm::length(place.position - glm::vec3(0.2F, 0.0F, 0.0F))}, 0.5, 0.05);
    }
    specs.push_back(std::string("cube:compare=less,size=64,box=-0.4/-0.6/-0.6/0.8/0.6/0.6,decode=plane"));
    const Measured cured = measuredPlaces(mesh, bakeSpecs(mesh, specs));
    const std::uint64_t left = cured.places.empty() ? 0 : cured.places[0].points;
    EXPECT_LT(left, found.places[0].points / 10);
    EXPECT_LT(cured.unseen_percent, 0.1);
}

TEST(WorstPlaces, PlateCausesSilhouetteErrors) {
    // A plate 0.1 thick hovers 0.02 above a block. The view from above cannot see into the gap. In the side view, one
    // texel of 0.25 contains the gap.
    const TriangleMesh mesh =
        joined({makeBoxMesh({0, -0.5, 0}, {1, 0.5, 1}), makeBoxMesh({0, 0.07, 0}, {1, 0.05, 1})});
    const Measured found =
        measuredPlaces(mesh, bakeSpecs(mesh, {std::string("front-back:dir=-y,size=64") + kPlanes,
                                              std::string("front-back:dir=-x,size=10") + kPlanes}));
    ASSERT_FALSE(found.places.empty());
    EXPECT_EQ(found.places[0].cause, WrongCause::kSilhouette) << wordOf(found.places[0].cause);
    EXPECT_EQ(found.places[0].map, 0);
    EXPECT_GT(found.places[0].false_inside_percent, 95.0);
    EXPECT_NEAR(double{found.places[0].position.y}, 0.01, 0.011);
}

TEST(WorstPlaces, OpenShellIsNamed) {
    // A sphere without its cap: most rays still find its inside, but the view from above looks into it.
    const TriangleMesh sphere =
        without(makeIcosphere({0, 0, 0}, 1.0, 4), [](const glm::dvec3& p) { return p.y > 0.8; });
    const Measured open =
        measuredPlaces(sphere, bakeSpecs(sphere, {std::string("front-back:dir=-y,size=64") + kPlanes}));
    ASSERT_FALSE(open.places.empty());
    EXPECT_EQ(open.places[0].cause, WrongCause::kOpen) << wordOf(open.places[0].cause);
    EXPECT_EQ(open.places[0].map, 0);
}

TEST(Sights, WallParallelToTheViewIsUnseen) {
    // Four of the six faces are parallel to the only view.
    const TriangleMesh box = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    for (const std::string& decode : {std::string(kPlanes), std::string()}) {
        EXPECT_NEAR(
            measuredPlaces(box, bakeSpecs(box, {"front-back:dir=-z,size=32" + decode})).unseen_percent,
            100.0 * 4.0 / 6.0, 1.0);
    }
}

}  // namespace
}  // namespace relief::test
