// SPDX-License-Identifier: Apache-2.0
// The worst places, sparse reference volumes and sizes of patches, compared with closed forms and manual counts.
#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <random>
#include <span>

#include "bake/bench/brick_volume.h"
#include "bake/measure/patch_cells.h"
#include "bake/measure/worst_places.h"
#include "formats/patch_tree.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/bake/threads.h"
#include "tests/formats/random_patches.h"

namespace relief::test {
namespace {

const std::string kPlanes = ",decode=plane,depth=unorm16";

struct Measured {
    std::vector<WorstPlace> places;
    double unseen_percent = 0.0;
};

Measured measuredPlaces(const TriangleMesh& mesh, const Collider& collider, std::uint32_t samples = 40'000) {
    const MeshQuery query = queryOf(mesh);
    const TruthSamples truth = sampleTruth(query, {.samples = samples});
    const Sights sights(collider.maps, query);
    return {worstPlaces(truth, query, sights, collider), sights.unseenPercent(truth.surface)};
}

std::vector<std::string> threeViews(const std::string& size) {
    const std::string rest = ",size=" + size + kPlanes;
    return {"front-back:dir=-x" + rest, "front-back:dir=-y" + rest, "front-back:dir=-z" + rest};
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
    specs.emplace_back("cube:compare=less,size=64,box=-0.4/-0.6/-0.6/0.8/0.6/0.6,decode=plane");
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
    const Measured found = measuredPlaces(mesh, bakeSpecs(mesh, {"front-back:dir=-y,size=64" + kPlanes,
                                                                 "front-back:dir=-x,size=10" + kPlanes}));
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
    const Measured open = measuredPlaces(sphere, bakeSpecs(sphere, {"front-back:dir=-y,size=64" + kPlanes}));
    ASSERT_FALSE(open.places.empty());
    EXPECT_EQ(open.places[0].cause, WrongCause::kOpen) << wordOf(open.places[0].cause);
    EXPECT_EQ(open.places[0].map, 0);
}

TEST(Sights, WallParallelToTheViewIsUnseen) {
    // Four of the six faces are parallel to the only view.
    const TriangleMesh box = makeBoxMesh({0, 0, 0}, {1, 1, 1});
    for (const std::string& decode : {kPlanes, std::string()}) {
        EXPECT_NEAR(
            measuredPlaces(box, bakeSpecs(box, {"front-back:dir=-z,size=32" + decode})).unseen_percent,
            100.0 * 4.0 / 6.0, 1.0);
    }
}

std::vector<BrickLayout> layouts() {
    return {{.cells = 3},
            {.cells = 8, .flat_index = true, .band = 4.0},
            {.cells = 2, .octree = true},
            {.cells = 3, .fitted = true},
            {.cells = 2, .octree = true, .fitted = true}};
}

TEST(BrickVolume, PlaneIsExactToQuantization) {
    // A rotated cube. Points near the middle of a face are affected only by its plane.
    const glm::dmat3 axes = rotation({1, 2, 0}, 35.0);
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {1, 1, 1}, axes));
    for (const BrickLayout& layout : layouts()) {
        const BrickVolume volume = BrickVolume::build(query, layout, 200'000);
        // The largest possible voxel there: a fifth of the distance to the edges of the face.
        std::mt19937 random(4);
        std::uniform_real_distribution<double> unit(-1.0, 1.0);
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 local(0.5 * unit(random), 1.0 + 0.002 * unit(random), 0.5 * unit(random));
            const FieldValue value = volume.at(glm::vec3(axes * local));
            const double quantum = layout.band * 0.1 / 127.0;
            ASSERT_NEAR(value.distance, local.y - 1.0, quantum) << volume.text();
            ASSERT_GT(glm::dot(glm::dvec3(value.normal), axes[1]), 0.995) << volume.text();
        }
    }
}

TEST(BrickVolume, SignsAreExactBeyondTheInterpolationError) {
    const MeshQuery query =
        queryOf(joined({makeIcosphere({-1.5, 0, 0}, 1.0, 5), makeIcosphere({1.25, 0.2, 0}, 0.75, 5)}));
    const TruthSamples samples = sampleTruth(query, {.samples = 2000});
    for (const BrickLayout& layout : layouts()) {
        const BrickVolume volume = BrickVolume::build(query, layout, 100'000);
        // Interpolation error: an eighth of the curvature times the voxel squared, for each of two axes. Leaves of an
        // octree can be four times the smallest.
        const double voxel = volume.voxel() * (layout.octree ? 4.0 : 1.0);
        const double bend = voxel * voxel / 0.75 / 4.0 + layout.band * voxel / 127.0;
        for (const std::vector<TruthPoint>* points : {&samples.near, &samples.uniform}) {
            for (const TruthPoint& point : *points) {
                const double distance = query.signedDistance(point.position);
                if (std::abs(distance) > bend) {
                    ASSERT_EQ(volume.at(point.position).distance < 0.0F, distance < 0.0)
                        << volume.text() << ", " << distance;
                }
            }
        }
        EXPECT_LT(measureField(samples, fieldOf(volume)).normal_mean, 2.0) << volume.text();
    }
}

TEST(BrickVolume, BytesAreNodesAndIndex) {
    const MeshQuery query = queryOf(makeBoxMesh({0, 0, 0}, {0.5, 0.25, 0.25}));
    BrickLayout layout{.cells = 4, .flat_index = true};
    // Voxels of 1/32: bricks of 1/8, so 8x4x4 in the box. The surface is on the outermost faces.
    const BrickVolume flat = BrickVolume::withVoxels(query, layout, 1.0 / 32.0);
    EXPECT_EQ(flat.nodeBytes(), flat.bricks() * 125);
    EXPECT_EQ(flat.indexBytes(), 8U * 4U * 4U * 2U);
    layout.flat_index = false;
    const BrickVolume levels = BrickVolume::withVoxels(query, layout, 1.0 / 32.0);
    // Two blocks of 4x4x4. Their lower level stores one byte per brick, relative to the first brick.
    EXPECT_EQ(levels.indexBytes(), 2U * (4U + 64U));
}

TEST(BrickVolume, BudgetIsUsedDeterministically) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.3, 96, 48));
    for (const BrickLayout& layout : layouts()) {
        for (const std::uint64_t bytes : {30'000U, 250'000U}) {
            const BrickVolume volume = BrickVolume::build(query, layout, bytes);
            EXPECT_LE(volume.bytes(), bytes) << volume.text();
            // With a few dozen large bricks, sizes change in large steps.
            EXPECT_GE(volume.bytes(), bytes - (volume.bricks() < 100 ? bytes / 2 : bytes / 10))
                << volume.text();
            EXPECT_NEAR(volume.at({2.3F, 0.0F, 0.0F}).distance, 1.0, 1e-2)
                << "beyond the box, distance to the box is included";
        }
        const auto build = [&] { return BrickVolume::build(query, layout, 20'000); };
        const BrickVolume single = onThreads(1, build);
        const BrickVolume many = build();
        for (const glm::vec3& p : pointsIn(query.mesh().bounds, 2000)) {
            ASSERT_EQ(many.at(p).distance, single.at(p).distance);
        }
    }
}

// A handmade tree with known leaves and sizes. Detects uncounted patches, confused siblings, and the heights of wrong
// leaves.

constexpr glm::vec3 kUp(0.0F, 0.0F, 1.0F);

/// Two roots along x, each 4 object units wide, from the origin. The first is split: octant 1 is a patch of 3² heights,
/// 6 is split and contains a patch of 5², the others have no record. The second root is outside.
DepthMap handMade() {
    const PatchFrame frame = patchFrames()[0];
    const std::uint32_t records = 6;
    std::vector<PatchRecord> texels = {
        PatchRecord::split(0b0100'0010U, 0, 3, kUp, 0.0F), PatchRecord::flat(false, kUp, 1.0F),
        PatchRecord::patch(frame, false, {.side = 3}, records),
        PatchRecord::split(0b0000'0001U, 0, 5, kUp, 0.0F),
        PatchRecord::patch(frame, false, {.side = 5}, records + heightTexels(3))};
    for (const PatchHeights& heights : {PatchHeights{.side = 3}, PatchHeights{.side = 5}}) {
        for (std::uint32_t i = 0; i < heightTexels(heights.side); ++i) {
            texels.push_back(heights.texel(i));
        }
    }
    DepthMap map = patchesOf({{2, 1, 1}, 2}, texels);
    for (int i = 0; i < 3; ++i) {
        map.object_to_map.row[i] = glm::vec4(0.0F);
        map.object_to_map.row[i][i] = 0.25F;
    }
    map.object_per_map = glm::vec3(4.0F);
    EXPECT_TRUE(validatePatches(map.texels));
    return map;
}

TEST(PatchCells, CountsCellsWithHeights) {
    DepthMap map = handMade();
    EXPECT_EQ(patchCount(map), 2U);
    // Heights can look like records.
    for (std::byte& byte : std::span(map.texels).subspan(std::size_t{6} * 8)) {
        byte = std::byte{3};
    }
    EXPECT_EQ(patchCount(map), 2U);
    EXPECT_EQ(patchCount(patchesOf({{1, 1, 1}, 0}, {PatchRecord::flat(true, kUp, -1.0F)})), 0U);
}

TEST(PatchCells, SpacingDependsOnTheLeaf) {
    const DepthMap map = handMade();
    EXPECT_EQ(patchSpacingAt(map, {3.0F, 1.0F, 1.0F}), 1.0) << "half a cell of 2";
    EXPECT_EQ(patchSpacingAt(map, {0.5F, 2.5F, 2.5F}), 0.25) << "a quarter of a cell of 1";
    EXPECT_EQ(patchSpacingAt(map, {0.5F, 3.5F, 2.5F}), 1.0) << "a neighbour without heights";
    EXPECT_EQ(patchSpacingAt(map, {1.0F, 1.0F, 1.0F}), 2.0) << "an octant without a record";
    EXPECT_EQ(patchSpacingAt(map, {6.0F, 1.0F, 1.0F}), 4.0) << "a root without heights";
    // Points beyond the roots and on their last faces use the nearest cell.
    EXPECT_EQ(patchSpacingAt(map, {3.0F, -9.0F, -9.0F}), 1.0);
    EXPECT_EQ(patchSpacingAt(map, {8.0F, 4.0F, 4.0F}), 4.0);
    EXPECT_EQ(patchSpacingAt(map, {1e30F, 0.0F, 0.0F}), 4.0);
}

}  // namespace
}  // namespace relief::test
