// SPDX-License-Identifier: Apache-2.0
// Patch trees: records against the points they were fitted to, and every way to break a tree. Material trees:
// closed-form lookups, rejected faults, and the container's bytes.
#include <gtest/gtest.h>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include "formats/collider.h"
#include "formats/container.h"
#include "formats/depth_map.h"
#include "formats/inspect.h"
#include "formats/material_response.h"
#include "formats/materials.h"
#include "formats/patch_tree.h"
#include "formats/validate.h"
#include "tests/formats/random_patches.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"

namespace relief::test {
namespace {

using test::patchesOf;
using test::randomPatches;

TEST(PatchFrame, CoversTheCubeAndHasTheGradientOfDepth) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    for (const PatchFrame& frame : patchFrames()) {
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 p(unit(random), unit(random), unit(random));
            const glm::dvec3 at = frame.across(p);
            EXPECT_GE(std::min(at.x, at.y), 0.0);
            EXPECT_LE(std::max(at.x, at.y), 1.0);
            EXPECT_GE(at.z, 0.0);
            EXPECT_LE(at.z, 1.0 + frame.diagonal);
            EXPECT_LT(glm::distance(glm::dvec3(frame.across(glm::vec3(p))), at), 1e-6);
            // The gradient of w − H with H = 0.3 u − 0.7 v, by finite differences.
            const auto value = [&](const glm::dvec3& q) {
                const glm::dvec3 there = frame.across(q);
                return there.z - 0.3 * there.x + 0.7 * there.y;
            };
            const glm::vec3 gradient = frame.gradient(0.3F, -0.7F);
            for (int axis = 0; axis < 3; ++axis) {
                glm::dvec3 step(0.0);
                step[axis] = 1e-4;
                EXPECT_NEAR((value(p + step) - value(p - step)) / 2e-4, gradient[axis], 1e-6);
            }
        }
    }
    // No two axes are parallel.
    for (const PatchFrame& a : patchFrames()) {
        for (const PatchFrame& b : patchFrames()) {
            const float cosine =
                std::abs(glm::dot(glm::normalize(a.gradient(0, 0)), glm::normalize(b.gradient(0, 0))));
            EXPECT_TRUE(a == b || cosine < 0.9F);
        }
    }
}

TEST(PatchHeights, AreWithinHalfAStep) {
    std::mt19937 random(2);
    for (const double range : {1e-5, 0.01, 0.3, 1.0, 3.5}) {
        std::uniform_real_distribution<double> unit(0.4 - range, 0.4 + range);
        for (const std::uint32_t side : {2U, 3U, 5U}) {
            std::vector<double> heights(side * side);
            for (double& height : heights) {
                height = unit(random);
            }
            const PatchHeights codes = PatchHeights::of(heights, side);
            std::vector<double> back(heights.size());
            codes.decode(back);
            // The range, plus up to 1/512 because the base lies below the lowest height, plus a sixteenth for the
            // mantissa. The step is at least that of the finest scale.
            const double step =
                std::max((2.0 * range + 1.0 / 512.0) * 17.0 / 16.0, std::ldexp(1.0, -12)) / 255.0;
            for (std::size_t i = 0; i < heights.size(); ++i) {
                EXPECT_NEAR(back[i], heights[i], 0.5001 * step) << range << " " << side;
            }
        }
    }
}

TEST(PatchTree, OutsideIsTheSignOfTheVote) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> anywhere(-0.2F, 4.2F);
    int outside = 0;
    int inside = 0;
    for (int tree = 0; tree < 50; ++tree) {
        const DepthMap map = randomPatches(random);
        for (int i = 0; i < 500; ++i) {
            const glm::vec3 p(anywhere(random), anywhere(random), anywhere(random));
            const std::optional<PatchVote> vote = votePatches(map.texels, p);
            ASSERT_EQ(isOutsidePatches(map.texels, p), vote && vote->distance >= 0.0F);
            outside += vote && vote->distance >= 0.0F ? 1 : 0;
            inside += vote && vote->distance < 0.0F ? 1 : 0;
        }
    }
    EXPECT_GT(outside, 1000);
    EXPECT_GT(inside, 1000);
}

/// Boxes with inside points are never rejected; most others are.
TEST(PatchTree, BoxesWithInsidePointsAreFound) {
    std::mt19937 random(9);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    int inside = 0;
    int rejected = 0;
    int undecided = 0;
    for (int tree = 0; tree < 200; ++tree) {
        Collider collider;
        collider.maps = {randomPatches(random)};
        DepthMap& map = collider.maps[0];
        // Turned about z, twice as large, shifted; mirrored in half of the trees.
        const float x = tree % 2 == 0 ? 1.0F : -1.0F;
        map.object_to_map = {
            {{0.3F * x, 0.4F, 0.0F, 0.5F}, {-0.4F * x, 0.3F, 0.0F, 2.0F}, {0.0F, 0.0F, 0.5F, -1.0F}}};
        map.object_per_map = glm::vec3(2.0F);
        const glm::dmat3 to_object = map.object_to_map.inverse();
        const auto objectOf = [&](const glm::vec3& in_map) {
            return glm::vec3(to_object * (glm::dvec3(in_map) - glm::dvec3(0.5, 2.0, -1.0)));
        };
        for (int i = 0; i < 100; ++i) {
            // In the roots and a little beyond; a third on borders of cells.
            glm::vec3 at =
                glm::vec3(3.4F, 2.4F, 4.4F) * glm::vec3(unit(random), unit(random), unit(random)) - 0.2F;
            at = i % 3 == 0 ? glm::floor(8.0F * at) / 8.0F : at;
            const glm::vec3 p = objectOf(at);
            if (evaluateInside(collider, p).inside) {
                ++inside;
                ASSERT_TRUE(mayBeInside(collider, {p, p})) << tree << " " << i;
                continue;
            }
            const Bounds box{p - 0.1F * unit(random), p + 0.1F * unit(random)};
            bool meets = false;
            for (int k = 0; k < 50; ++k) {
                const glm::vec3 share(unit(random), unit(random), unit(random));
                meets = meets || evaluateInside(collider, box.min + share * box.size()).inside;
            }
            const bool may = mayBeInside(collider, box);
            ASSERT_TRUE(may || !meets) << tree << " " << i;
            rejected += may ? 0 : 1;
            undecided += may && !meets ? 1 : 0;
        }
        const Bounds beyond{glm::vec3(100.0F), glm::vec3(101.0F)};
        EXPECT_EQ(mayBeInside(collider, beyond), !map.encloses);
        map.encloses = !map.encloses;
        EXPECT_EQ(mayBeInside(collider, beyond), !map.encloses);
    }
    EXPECT_GT(inside, 1000);
    EXPECT_GT(rejected, 1000);
    EXPECT_LT(undecided, rejected / 4);
}

TEST(PatchTree, PlanesAreExactUpToTheirCodes) {
    // Every frame and size stores the plane n·p = 0.5·(n.x + n.y + n.z) through the cell's centre, seen from above.
    for (const PatchFrame& frame : patchFrames()) {
        const glm::dvec3 along = glm::normalize(glm::dvec3(frame.gradient(0.0F, 0.0F)));
        const glm::dvec3 n = glm::normalize(along + glm::dvec3(0.21, -0.17, 0.11));
        for (const std::uint32_t side : {2U, 3U, 5U}) {
            std::vector<double> heights;
            for (std::uint32_t k = 0; k < side * side; ++k) {
                // By bisection along w, because across() has no inverse.
                const double u = (k % side) / (side - 1.0);
                const double v = (k / side) / (side - 1.0);
                const auto [origin, way] = [&] {
                    const glm::dvec3 zero = frame.across(glm::dvec3(0.0));
                    const glm::dmat3 m(frame.across(glm::dvec3(1, 0, 0)) - zero,
                                       frame.across(glm::dvec3(0, 1, 0)) - zero,
                                       frame.across(glm::dvec3(0, 0, 1)) - zero);
                    const glm::dmat3 back = glm::inverse(m);
                    return std::pair(back * (glm::dvec3(u, v, 0.0) - zero), back[2]);
                }();
                heights.push_back(glm::dot(n, glm::dvec3(0.5) - origin) / glm::dot(n, way));
            }
            for (const bool outside_below : {false, true}) {
                const PatchHeights codes = PatchHeights::of(heights, side);
                std::vector<PatchRecord> texels = {PatchRecord::patch(frame, outside_below, codes, 2)};
                for (std::uint32_t k = 0; k < heightTexels(side); ++k) {
                    texels.push_back(codes.texel(k));
                }
                const DepthMap map = patchesOf({{1, 1, 1}, 0}, texels);
                ASSERT_TRUE(validatePatches(map.texels)) << validatePatches(map.texels).error().message;
                std::mt19937 random(3);
                std::uniform_real_distribution<double> unit(0.0, 1.0);
                for (int i = 0; i < 100; ++i) {
                    glm::dvec3 p(unit(random), unit(random), unit(random));
                    for (int k = 0; i < 8 && k < 3; ++k) {
                        p[k] *= i >> k & 1;  // mirrored frames transform 0 to their last row or column
                    }
                    const Vote said = *vote(map, glm::vec3(p));
                    const double sign = outside_below ? -1.0 : 1.0;
                    EXPECT_NEAR(said.distance, sign * glm::dot(n, p - 0.5), 1.5 * double{codes.step()});
                    EXPECT_GT(glm::dot(glm::dvec3(said.normal), sign * n),
                              std::cos(4.0 * side * codes.step()));
                    EXPECT_NEAR(glm::length(said.normal), 1.0F, 1e-6F);
                }
            }
        }
    }
}

TEST(PatchTree, PairsAreIntersectionsOrUnions) {
    // A wall whose sides see each other's back, and the edge between two perpendicular walls.
    const auto plane = [](const PatchFrame& frame, bool outside_below, double height) {
        return PatchRecord::patch(frame, outside_below, PatchHeights::of(std::vector(4, height), 2), 0);
    };
    const PatchFrame& x = patchFrames()[0];
    const PatchFrame& y = patchFrames()[1];
    ASSERT_EQ(x.first, 0);
    ASSERT_EQ(y.first, 1);
    for (const bool both : {true, false}) {
        const DepthMap wall = patchesOf(
            {{1, 1, 1}, 0}, {PatchRecord::pair(both, 2), plane(x, both, 0.375), plane(x, !both, 0.5)});
        const DepthMap edge = patchesOf(
            {{1, 1, 1}, 0}, {PatchRecord::pair(both, 2), plane(x, false, 0.5), plane(y, false, 0.75)});
        for (const DepthMap* map : {&wall, &edge}) {
            ASSERT_TRUE(validatePatches(map->texels)) << validatePatches(map->texels).error().message;
        }
        std::mt19937 random(4);
        std::uniform_real_distribution<float> unit(0.0F, 1.0F);
        for (int i = 0; i < 200; ++i) {
            const glm::vec3 p(unit(random), unit(random), unit(random));
            const float way = both ? 1.0F : -1.0F;
            EXPECT_NEAR(vote(wall, p)->distance, way * std::max(0.375F - p.x, p.x - 0.5F), 1e-6F);
            const float of_edge =
                both ? std::max(p.x - 0.5F, p.y - 0.75F) : std::min(p.x - 0.5F, p.y - 0.75F);
            EXPECT_NEAR(vote(edge, p)->distance, of_edge, 1e-6F);
            const bool by_x = both == (p.x - 0.5F > p.y - 0.75F);
            EXPECT_NEAR(vote(edge, p)->normal[by_x ? 0 : 1], 1.0F, 1e-6F);
        }
    }
}

TEST(PatchTree, CellsWithoutPatchesKeepTheirSide) {
    // Two roots: one flat and outside, the other split, with a record for only one child, which is flat and inside.
    const glm::vec3 up(0, 1, 0);
    const DepthMap map = patchesOf(
        {{2, 1, 1}, 1}, {PatchRecord::flat(false, up, 0.25F), PatchRecord::split(0x80, 0x0f, 3, up, 0.1F),
                         PatchRecord::flat(true, up, -0.25F)});
    ASSERT_TRUE(validatePatches(map.texels)) << validatePatches(map.texels).error().message;
    const auto at = [&](float x, float y, float z) { return *vote(map, {x, y, z}); };
    EXPECT_NEAR(at(0.5F, 0.5F, 0.5F).distance, 0.25F, 1e-6F);
    EXPECT_NEAR(at(0.5F, 0.9F, 0.5F).distance, 0.65F, 1e-6F);
    EXPECT_GT(at(0.5F, 0.1F, 0.5F).distance, 0.0F) << "outside, although the plane's distance is −0.15";
    EXPECT_LT(at(0.5F, 0.1F, 0.5F).distance, 0.01F);
    EXPECT_LT(at(1.25F, 0.9F, 0.25F).distance, 0.0F) << "inside, although the plane's distance is 0.5";
    // Offsets have steps of 1/128; the normal is exact.
    EXPECT_NEAR(at(1.25F, 0.1F, 0.25F).distance, -0.3F, 4e-3F);
    EXPECT_NEAR(at(1.25F, 0.9F, 0.75F).distance, 0.5F, 4e-3F);
    EXPECT_NEAR(at(1.75F, 0.75F, 0.75F).distance, -0.25F, 1e-6F);
    EXPECT_EQ(at(-0.1F, 0.5F, 0.5F).distance, kFarOutside);
    EXPECT_EQ(at(2.0F, 0.5F, 0.5F).distance, kFarOutside);
    EXPECT_EQ(at(std::nanf(""), 0.5F, 0.5F).distance, kFarOutside);
    DepthMap part = map;
    part.encloses = false;
    EXPECT_FALSE(vote(part, {-0.1F, 0.5F, 0.5F}));
    EXPECT_TRUE(vote(part, {0.5F, 0.5F, 0.5F}));
}

TEST(PatchTree, BrokenTreesAreRejected) {
    const glm::vec3 up(0, 1, 0);
    const PatchRecord leaf = PatchRecord::flat(true, up, -1.0F);
    const std::vector<double> heights(25, 0.5);
    const PatchHeights codes = PatchHeights::of(heights, 5);
    const PatchFrame frame = patchFrames()[0];
    const auto refused = [](const PatchTreeSize& size, const std::vector<PatchRecord>& records,
                            const char* text) {
        const Result<void> valid = validatePatches(patchesOf(size, records).texels);
        ASSERT_FALSE(valid) << text;
        EXPECT_NE(valid.error().message.find(text), std::string::npos) << valid.error().message;
    };
    refused({{0, 1, 1}, 0}, {leaf}, "an invalid size");
    refused({{65535, 65535, 65535}, 0}, {leaf}, "an invalid size");
    refused({{1, 1, 1}, kPatchLevelsMax + 1}, {leaf}, "an invalid size");
    // Children that are the node itself, not the next texels, beyond the map, or deeper than the header states.
    refused({{1, 1, 1}, 3}, {PatchRecord::split(1, 0, 1, up, 0)}, "not the next texels");
    refused({{1, 1, 1}, 3}, {PatchRecord::split(1, 0, 3, up, 0), leaf, leaf}, "not the next texels");
    std::vector<PatchRecord> beyond(16, leaf);  // room for 15 children
    beyond[0] = PatchRecord::split(0xff, 0, 17, up, 0);
    beyond[1] = PatchRecord::split(0xff, 0, 25, up, 0);
    refused({{4, 4, 1}, 1}, beyond, "not the next texels");
    refused({{1, 1, 1}, 0}, {PatchRecord::split(1, 0, 2, up, 0), leaf}, "not the next texels");
    refused({{1, 1, 1}, 0}, {PatchRecord::patch(frame, false, codes, 1)}, "heights are out of place");
    refused({{1, 1, 1}, 0}, {PatchRecord::patch(frame, false, codes, 14)}, "heights are out of place");
    PatchRecord odd;
    for (const unsigned bit : {5U, 7U}) {  // the diagonal and the first axis
        odd = PatchRecord::patch(frame, false, codes, 2);
        odd.low |= 3U << bit;
        refused({{1, 1, 1}, 0}, {odd}, "an unknown kind");
    }
    // Pairs that refer to themselves, beyond the map, to another kind, to pairs, and to patches without heights.
    refused({{1, 1, 1}, 0}, {PatchRecord::pair(true, 1)}, "patches are out of place");
    refused({{1, 1, 1}, 0}, {PatchRecord::pair(true, 15)}, "patches are out of place");
    refused({{1, 1, 1}, 0}, {PatchRecord::pair(true, 2), leaf, leaf}, "an unknown kind");
    const PatchRecord flat =
        PatchRecord::patch(frame, false, PatchHeights::of(std::array{0.1, 0.2, 0.3, 0.4}, 2), 0);
    refused({{1, 1, 1}, 0}, {PatchRecord::pair(true, 2), flat, PatchRecord::pair(true, 2)},
            "an unknown kind");
    refused({{1, 1, 1}, 0}, {PatchRecord::pair(true, 2), flat, PatchRecord::patch(frame, false, codes, 14)},
            "heights are out of place");
    odd = PatchRecord::flat(true, up, std::nanf(""));
    refused({{1, 1, 1}, 0}, {odd}, "not finite");
    odd = leaf;
    odd.low |= 0xff000000U;
    refused({{1, 1, 1}, 0}, {odd}, "index 255");
    DepthMap none;
    none.format = MapFormat::kPatches;
    EXPECT_FALSE(validatePatches(none.texels));
}

TEST(PatchTree, NonUniformFramesAreRejected) {
    std::mt19937 random(6);
    DepthMap map = randomPatches(random);
    EXPECT_TRUE(validateFrame(map)) << validateFrame(map).error().message;
    map.object_per_map.y = 2.0F;
    map.object_to_map.row[1] *= 0.5F;
    EXPECT_FALSE(validateFrame(map));
}

TEST(Materials, LookupFindsTheCell) {
    const Materials materials = someMaterials();
    ASSERT_EQ(faultOfMaterials(materials), "");
    const glm::vec3 up(0.0F, 1.0F, 0.0F);
    const auto at = [&](float x, float y, float z) { return materialAt(materials, {x, y, z}, up); };
    EXPECT_EQ(at(0.5F, 0.5F, 0.5F), 2U);
    EXPECT_EQ(at(1.5F, 0.5F, 0.5F), 1U);
    EXPECT_EQ(at(0.5F, 0.5F, 1.0F), 1U);
    EXPECT_EQ(at(0.0F, 0.0F, 0.0F), 2U);  // points between two cells belong to the upper cell
    EXPECT_EQ(at(-1e-6F, 0.5F, 0.5F), 0U);
    // Points outside the cube, and NaN coordinates, use the nearest cell.
    EXPECT_EQ(at(99.0F, 99.0F, 99.0F), 1U);
    EXPECT_EQ(at(1e30F, 0.5F, 0.5F), 1U);
    EXPECT_EQ(at(std::nanf(""), -99.0F, 0.5F), 0U);
    // A pair of sides along x − y.
    const glm::vec3 low(-1.0F);
    EXPECT_EQ(materialAt(materials, low, {1.0F, 0.0F, 0.0F}), 1U);
    EXPECT_EQ(materialAt(materials, low, {0.0F, 1.0F, 0.0F}), 2U);
    EXPECT_EQ(materialAt(materials, low, {0.0F, -9.0F, 0.0F}), 1U);
}

TEST(Materials, NineAxesDistinguishSides) {
    const glm::vec3 v(1.0F, 2.0F, 4.0F);
    const std::array<float, kMaterialAxes> along{1.0F, 2.0F, 4.0F, 3.0F, -1.0F, 5.0F, -3.0F, 6.0F, -2.0F};
    for (int axis = 0; axis < kMaterialAxes; ++axis) {
        EXPECT_EQ(alongMaterialAxis(v, axis), along[static_cast<std::size_t>(axis)]) << axis;
    }
}

TEST(Materials, EveryFaultIsDetected) {
    struct Case {
        const char* message;
        std::function<void(Materials&)> change;
    };
    for (const Case& wrong : std::vector<Case>{
             {"a material tree, but no materials", [](auto& m) { m.list.clear(); }},
             {"materials[1] repeats the name 'oak'", [](auto& m) { m.list[1].name = "oak"; }},
             {"materials[0] has a name that is not clean UTF-8", [](auto& m) { m.list[0].name = "\x80"; }},
             {"longer than 256 bytes", [](auto& m) { m.list[0].name.assign(257, 'a'); }},
             {"materials[2] has a restitution", [](auto& m) { m.list[2].restitution = 1.5F; }},
             {"materials[2] has a restitution", [](auto& m) { m.list[2].friction = std::nanf(""); }},
             {"materials[1] has a lifetime_loss", [](auto& m) { m.list[1].lifetime_loss = -1.0F; }},
             {"there are 256 materials", [](auto& m) { m.list.resize(256); }},
             {"together with the materials, more than 256", [](auto& m) { m.sides.resize(254); }},
             {"a pair of sides", [](auto& m) { m.sides[0].axis = 9; }},
             {"a pair of sides", [](auto& m) { m.sides[0].against = 3; }},
             {"the cube of the materials", [](auto& m) { m.size = 0.0F; }},
             {"the cube of the materials", [](auto& m) { m.origin.x = std::nanf(""); }},
             {"node 0 has its octants", [](auto& m) { m.nodes[0].head = 0x80U; }},
             {"node 0 has its octants", [](auto& m) { m.nodes[0].head = 2U << 8U | 0x80U; }},
             {"node 1 has its octants", [](auto& m) { m.nodes[1].head = 1U << 8U; }},
             {"material node 1 has no parent", [](auto& m) { m.nodes[0].head = 0; }},
             {"material nodes are missing",
              [](auto& m) {
                  m.nodes[1].head = 2U << 8U | 1U;
                  m.nodes[1].leaves[0] = 0;
              }},
             {"octant with an invalid material", [](auto& m) { m.nodes[1].leaves[3] = 4; }},
             {"octant with an invalid material", [](auto& m) { m.nodes[0].leaves[7] = 1; }}}) {
        Materials materials = someMaterials();
        wrong.change(materials);
        const std::string fault = faultOfMaterials(materials);
        EXPECT_NE(fault.find(wrong.message), std::string::npos) << wrong.message << ": " << fault;
    }
    // A chain of nodes is rejected if it is too deep for a lookup.
    Materials deep = someMaterials();
    deep.nodes.assign(kMaterialLevelsMax + 1, {});
    for (std::size_t i = 0; i + 1 < deep.nodes.size(); ++i) {
        deep.nodes[i].head = static_cast<std::uint32_t>(i + 1) << 8U | 1U;
    }
    EXPECT_NE(faultOfMaterials(deep).find("is too deep"), std::string::npos) << faultOfMaterials(deep);
    deep.nodes.pop_back();
    deep.nodes.back().head = 0;
    EXPECT_EQ(faultOfMaterials(deep), "");
}

TEST(Materials, RoundTripInContainersAndLeaveOthersUnchanged) {
    Collider collider = readmeExample();
    const std::vector<std::byte> without = written(collider);
    collider.materials = someMaterials();
    for (const int level : {0, 9}) {
        const std::vector<std::byte> bytes = written(collider, level);
        const Collider read = required(readContainer(bytes));
        EXPECT_EQ(read, collider);
        EXPECT_FALSE(required(inspectContainer(bytes)).damaged());
    }
    collider.materials = {};
    EXPECT_EQ(written(collider), without);
    collider.materials = someMaterials();
    collider.materials.nodes[0].head = 0x80U;
    EXPECT_FALSE(writeContainer(collider));
}

TEST(Materials, ResponsesAreSetByName) {
    Materials materials = someMaterials();
    const std::vector<MaterialResponse> responses{{"stone", 0.1F, {}, 5.0F}, {"stove", {}, {}, {}}};
    EXPECT_EQ(repeatedName(responses), std::nullopt);
    MaterialResponses given(responses);
    given.apply(materials);
    EXPECT_EQ(materials.list[0], someMaterials().list[0]);
    EXPECT_EQ(materials.list[1], (Material{"stone", 0.1F, 0.0F, 5.0F, 0.25F}));
    EXPECT_EQ(given.faultOf("stone"), std::nullopt);
    EXPECT_EQ(given.faultOf("stoen").value_or(""),
              "is not the name of a material; did you mean 'stone'? There are '', 'oak', 'stone'");
    EXPECT_EQ(MaterialResponses({}).faultOf("x").value_or(""),
              "is not the name of a material: the colliders have none; bake a mesh with several, or with "
              "--materials keep");
    const std::vector<MaterialResponse> twice{{"a", {}, {}, {}}, {"b", {}, {}, {}}, {"a", {}, {}, {}}};
    EXPECT_EQ(repeatedName(twice), 2U);
}

}  // namespace
}  // namespace relief::test
