// SPDX-License-Identifier: Apache-2.0
// Proven bounds of errors compared with closed forms, and with random points of damaged trees.
#include "bake/measure/depth_proof.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <stdexcept>

#include "bake/measure/truth.h"
#include "bake/patches/patch_planner.h"
#include "formats/validate.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/bake/threads.h"
#include "tests/formats/random_patches.h"

namespace relief::test {
namespace {

/// Few boxes: an error of a tenth of the mesh needs no more.
constexpr DepthProofOptions kFew{.boxes_max = 60'000};

Collider colliderOf(const MeshQuery& query, DepthMap map) {
    Collider collider;
    collider.bounds = query.mesh().bounds;
    collider.maps.push_back(std::move(map));
    return collider;
}

Collider bakedOf(const MeshQuery& query, std::uint64_t bytes) {
    return colliderOf(query, bakePatches(query, {.bytes = bytes})->map);
}

/// A cube of one root, filled up to a height along z.
Collider filledTo(const MeshQuery& query, double height) {
    const PatchHeights heights = PatchHeights::of(std::vector(4, height), 2);
    return colliderOf(query, patchesOf({{1, 1, 1}, 0}, {PatchRecord::patch({0, 2, 0}, false, heights, 0)}));
}

/// Returns the depth of the deepest wrong point of random ones, also of those near the surface.
double deepestOf(const MeshQuery& query, const Collider& collider, int count) {
    double deepest = 0.0;
    const auto test = [&](const glm::vec3& p) {
        if (evaluateInside(collider, p).inside != query.inside(p)) {
            deepest = std::max(deepest, query.closest(p).distance);
        }
    };
    for (const glm::vec3& p : pointsIn(collider.bounds, count)) {
        test(p);
    }
    for (const TruthPoint& point :
         sampleNear(query, {.samples = static_cast<std::uint32_t>(count), .seed = 3})) {
        test(point.position);
    }
    return deepest;
}

/// Index of the first root that is inside and has no heights.
std::uint32_t firstInside(PatchTexels texels) {
    const glm::uvec3 roots = patchTreeSize(texels).roots;
    std::uint32_t leaf = 1;
    while (patchTexel(texels, leaf).kind() != PatchRecord::Kind::kInside) {
        if (++leaf > roots.x * roots.y * roots.z) {
            throw std::runtime_error("no root is inside");
        }
    }
    return leaf;
}

void expectErrorAt(const MeshQuery& query, const Collider& collider, const DepthProof& proof) {
    EXPECT_NE(evaluateInside(collider, proof.place).inside, query.inside(proof.place));
    EXPECT_NEAR(query.closest(proof.place).distance, proof.deepest, 1e-6);
}

TEST(DepthProof, MatchesTheErrorOfAFilledCube) {
    // The mesh fills the root up to a half, the field up to another height.
    const MeshQuery query = queryOf(makeBoxMesh({0.5, 0.5, 0.25}, {0.5, 0.5, 0.25}));
    for (const double error : {0.25, 0.1, -0.1, -0.2}) {
        const Collider collider = filledTo(query, 0.5 + error);
        const PatchTexels texels = collider.maps[0].texels;
        const double actual = std::abs(double{patchHeights(texels, patchTexel(texels, 1)).low()} - 0.5);
        const DepthProof proof = proveDepth(query, collider, kFew);
        EXPECT_EQ(proof.unproven, "");
        EXPECT_GE(proof.depth, actual) << error;
        EXPECT_LE(proof.depth, 1.11 * actual) << error;
        EXPECT_LE(proof.deepest, actual * (1.0 + 1e-6)) << error;
        expectErrorAt(query, collider, proof);
    }
    EXPECT_LE(proveDepth(query, filledTo(query, 0.5), kFew).depth, 0.03);
}

TEST(DepthProof, IncludesRoundingFarFromTheOrigin) {
    const MeshQuery near = queryOf(makeBoxMesh({0.5, 0.5, 0.25}, {0.5, 0.5, 0.25}));
    // At 10⁵ a float has steps of 1/128.
    const MeshQuery far = queryOf(makeBoxMesh({100000.5, 0.5, 0.25}, {0.5, 0.5, 0.25}));
    Collider moved = filledTo(far, 0.6);
    moved.maps[0].object_to_map.row[0].w = -100000.0F;
    const double rounding =
        proveDepth(far, moved, kFew).depth - proveDepth(near, filledTo(near, 0.6), kFew).depth;
    EXPECT_GT(rounding, 1.0 / 256.0);
    EXPECT_LT(rounding, 0.5);
}

TEST(DepthProof, FindsACellOfTheWrongSide) {
    const MeshQuery query = queryOf(makeIcosphere({0.1, -0.2, 0.3}, 1.0, 4));
    const Collider sound = bakedOf(query, 16'384);
    const DepthProof before = proveDepth(query, sound, kFew);
    EXPECT_EQ(before.unproven, "");
    EXPECT_LT(before.depth, 0.06);
    // The first leaf without heights changes its side, in one bit.
    Collider damaged = sound;
    std::vector<std::byte>& texels = damaged.maps[0].texels;
    texels[std::size_t{firstInside(texels)} * kPatchTexelBytes] ^= std::byte{1};
    ASSERT_TRUE(validateTexels(damaged.maps[0]));
    const DepthProof after = proveDepth(query, damaged, kFew);
    EXPECT_GT(after.deepest, before.depth);
    EXPECT_LE(after.depth, 1.11 * after.deepest);
    expectErrorAt(query, damaged, after);
}

TEST(DepthProof, NoRandomPointIsDeeperInDamagedTrees) {
    const MeshQuery query = queryOf(makeTorusMesh(1.0, 0.4, 24, 12));
    const Collider sound = bakedOf(query, 8192);
    std::mt19937 random(11);
    int changed = 0;
    for (int round = 0; round < 24; ++round) {
        Collider damaged = sound;
        std::vector<std::byte>& texels = damaged.maps[0].texels;
        // One bit in ten texels behind the size.
        for (int i = 0; i < 10; ++i) {
            std::byte& byte = texels[8 + random() % (texels.size() - 8)];
            const std::byte before = byte;
            byte ^= std::byte{1} << (random() % 8);
            byte = validateTexels(damaged.maps[0]) ? byte : before;
        }
        const DepthProof proof = proveDepth(query, damaged, {.boxes_max = 300'000});
        const double found = deepestOf(query, damaged, 5000);
        EXPECT_LE(found, proof.depth);
        EXPECT_GE(1.11 * proof.deepest + 3e-4, found);
        changed += found > 0.05 ? 1 : 0;
    }
    EXPECT_GE(changed, 6);
}

TEST(DepthProof, HoldsForEveryFrameAndPair) {
    // Random records around a ball: only the bounds of patches decide which boxes remain.
    std::mt19937 random(5);
    for (int round = 0; round < 4; ++round) {
        const MeshQuery query = queryOf(makeIcosphere({1.5, 1.0, 2.0}, 0.9, 3));
        Collider collider = colliderOf(query, randomPatches(random));
        collider.bounds = {glm::vec3(0.0F), glm::vec3(3.0F, 2.0F, 4.0F)};
        const DepthProof proof = proveDepth(query, collider);
        EXPECT_LE(deepestOf(query, collider, 20'000), proof.depth);
        EXPECT_LE(proof.depth, 1.11 * proof.deepest);
        expectErrorAt(query, collider, proof);
    }
}

TEST(DepthProof, EndsEarlyWithALargerBoundAndOnAnyThreads) {
    const MeshQuery query = queryOf(makeIcosphere({0, 0, 0}, 1.0, 4));
    const Collider collider = bakedOf(query, 32'768);
    const DepthProof whole = proveDepth(query, collider, kFew);
    const DepthProof early = proveDepth(query, collider, {.boxes_max = 1});
    EXPECT_LT(early.boxes, whole.boxes);
    EXPECT_GT(early.depth, whole.depth);
    EXPECT_LE(early.deepest, whole.deepest);
    const DepthProof one = onThreads(1, [&] { return proveDepth(query, collider, kFew); });
    EXPECT_EQ(one.depth, whole.depth);
    EXPECT_EQ(one.deepest, whole.deepest);
    EXPECT_EQ(one.boxes, whole.boxes);
}

TEST(DepthProof, NamesWhatItCannotProve) {
    const TriangleMesh ball = makeIcosphere({0, 0, 0}, 1.0, 3);
    const MeshQuery query = queryOf(ball);
    // A vote of −(largest float) or less is no vote: the cell would be outside.
    Collider distant = bakedOf(query, 16'384);
    std::vector<std::byte>& texels = distant.maps[0].texels;
    const std::uint32_t leaf = firstInside(texels);
    PatchRecord record = patchTexel(texels, leaf);
    record.high = std::bit_cast<std::uint32_t>(-std::numeric_limits<float>::max());
    std::memcpy(&texels[std::size_t{leaf} * kPatchTexelBytes], &record, kPatchTexelBytes);
    ASSERT_TRUE(validateTexels(distant.maps[0]));
    EXPECT_EQ(proveDepth(query, distant).unproven, "the map has coordinates or distances out of range");
    // Ten bytes of a file may stand for millions of cells.
    const std::vector<PatchRecord> roots(std::size_t{100} * 100 * 100,
                                         PatchRecord::split(0, 255, 1'000'001, {0, 0, 1}, 0.0F));
    const Collider collider = colliderOf(query, patchesOf({{100, 100, 100}, 1}, roots));
    ASSERT_TRUE(validateTexels(collider.maps[0]));
    EXPECT_EQ(proveDepth(query, collider).unproven, "the map has too many cells");
    const Collider named = bakeSpecs(ball, {"float:dir=+z,size=16x16"});
    EXPECT_EQ(proveDepth(query, named).unproven, "the collider is not one map of patches");
    const Collider patches = bakedOf(query, 4096);
    TriangleMesh open = ball;
    open.triangles.pop_back();
    EXPECT_EQ(proveDepth(queryOf(open), patches).unproven, "the mesh is not closed");
    const MeshQuery larger = queryOf(makeIcosphere({0, 0, 0}, 3.0, 3));
    EXPECT_EQ(proveDepth(larger, patches).unproven, "the mesh reaches outside the cells of the map");
}

}  // namespace
}  // namespace relief::test
