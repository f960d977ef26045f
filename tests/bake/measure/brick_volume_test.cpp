// SPDX-License-Identifier: Apache-2.0
// The sparse reference volumes compared with closed forms, and their sizes with manual counts.
#include "bake/bench/brick_volume.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <random>

#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/bake/threads.h"

namespace relief::test {
namespace {

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

}  // namespace
}  // namespace relief::test
