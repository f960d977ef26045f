// SPDX-License-Identifier: Apache-2.0
// The rivals of relief-bench on the GPU: bricks against the volume on the CPU; exact meshes against brute force and
// winding numbers. A comparison with a wrong rival would be worthless.
#include <gtest/gtest.h>
#include <cmath>
#include <glm/geometric.hpp>

#include "bake/bench/brick_volume.h"
#include "bake/bench/distance_volume.h"
#include "bake/import/mesh_import.h"
#include "bake/mesh/mesh_query.h"
#include "runtime/bench/rival_step.h"
#include "runtime/gl/pass_state.h"
#include "runtime/particles/random.h"
#include "tests/bake/meshes.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/runtime/gl/query_program.h"

namespace relief::test {
namespace {

constexpr std::uint32_t kParticles = 64 * 1024;

std::string pathName(const testing::TestParamInfo<StepPath>& path) {
    return path.param == StepPath::kCompute ? "Compute" : "Fragment";
}

/// A volume on the CPU and on the GPU.
struct Baseline {
    BrickAtlas atlas;
    Field cpu;
    float voxel;
};

float distanceAt(const Baseline& baseline, const glm::vec3& p) {
    return baseline.cpu(p)->distance;
}

/// The particles' textures, one texel per particle.
struct State {
    std::vector<float> position;
    std::vector<float> velocity;

    State(const GlTexture& positions, const GlTexture& velocities, std::size_t count) {
        const PassState restored;
        constexpr auto kWidth = static_cast<GLsizei>(ParticleSystem::kStateWidth);
        const auto rows = static_cast<GLsizei>(count) / kWidth;
        position = required(readTextureFloats(positions, kWidth, rows));
        velocity = required(readTextureFloats(velocities, kWidth, rows));
    }
    explicit State(const RivalStep& step) : State(step.positions(), step.velocities(), kParticles) {}
    [[nodiscard]] glm::vec3 p(std::size_t i) const {
        return {position[4 * i], position[4 * i + 1], position[4 * i + 2]};
    }
    [[nodiscard]] glm::vec3 v(std::size_t i) const {
        return {velocity[4 * i], velocity[4 * i + 1], velocity[4 * i + 2]};
    }
    [[nodiscard]] bool touched(std::size_t i) const { return position[4 * i + 3] != 0.0F; }
    [[nodiscard]] Contact contact(std::size_t i) const {
        return static_cast<Contact>(static_cast<int>(velocity[4 * i + 3]));
    }
};

class BrickRivalGlTest : public testing::TestWithParam<StepPath> {
  protected:
    void SetUp() override {
        context_ = required(GlContext::create(GlApi::kGl33Core));
        // Rotated, so that no axes of grid, texture and box are parallel.
        const glm::dmat3 turn = test::rotation({1, 2, 3}, 40.0);
        TriangleMesh mesh = test::joined({test::makeTorusMesh(1.0, 0.35, 96, 48),
                                          test::makeBoxMesh({0.1, 0.2, 0.9}, {0.9, 0.3, 0.2}, turn)});
        query_ = std::make_unique<MeshQuery>(required(MeshQuery::build(std::move(mesh))));
        Collider box;  // only provides the box of a scene
        box.bounds = query_->mesh().bounds;
        scene_ = makeBenchScene(std::move(box), kParticles, kBenchLifetime);
    }

    [[nodiscard]] Baseline bricks(unsigned cells) {
        bricks_ = std::make_unique<BrickVolume>(
            BrickVolume::build(*query_, {.cells = cells, .flat_index = true}, 200'000));
        return {bricks_->atlas(), fieldOf(*bricks_), static_cast<float>(bricks_->voxel())};
    }
    [[nodiscard]] Baseline dense() {
        const DistanceGrid grid =
            sampleDistances(*query_, makeLattice(query_->mesh().bounds, 100'000, LatticeFit::kCorner));
        dense_ = std::make_unique<DistanceVolume>(grid, DistanceVolume::bandRange(grid, 0.02));
        return {dense_->atlas(), fieldOf(*dense_), static_cast<float>(grid.lattice.spacing.x)};
    }

    /// One step from birth, then fifteen more.
    void expectCpuSides(const Baseline& baseline) {
        RivalStep step =
            required(RivalStep::create(required(makeBrickRival(baseline.atlas)), scene_, GetParam()));
        EXPECT_GE(step.bytes(), baseline.atlas.bytes);
        // Except for atlas slots without a brick.
        EXPECT_LE(step.bytes(), baseline.atlas.bytes + baseline.atlas.bytes / 100);
        step.begin(scene_);
        expectCpuReactions(baseline, State(step));
        for (int i = 0; i < 15; ++i) {
            step.step();
        }
        const State after(step);
        std::size_t outside = 0, inside = 0;
        for (std::size_t i = 0; i < kParticles; ++i) {
            if (after.contact(i) == Contact::kCaught) {
                ++inside;
                continue;
            }
            ++outside;
            ASSERT_GT(distanceAt(baseline, after.p(i)), -margin(baseline)) << i;
        }
        EXPECT_GT(outside, kParticles / 2);
        EXPECT_GT(inside, 100U);
    }

    /// Texture unit weights may have only 8 bits: an error of that fraction of a voxel along each axis.
    static float margin(const Baseline& baseline) { return 0.012F * baseline.voxel; }

    void expectCpuReactions(const Baseline& baseline, const State& after) {
        const Forces& forces = scene_.forces;
        std::size_t free = 0, hit = 0, caught = 0, pushed = 0, off = 0;
        for (std::size_t i = 0; i < kParticles; ++i) {
            const Birth& birth = scene_.births[i];
            const glm::vec3 v = (birth.velocity + kBenchDt * (forces.gravity + forces.drag * forces.wind)) /
                                (1.0F + kBenchDt * forces.drag);
            const glm::vec3 to = birth.position + kBenchDt * v;
            const FieldValue end = *baseline.cpu(to);
            const float before = distanceAt(baseline, birth.position);
            if (std::abs(end.distance) < margin(baseline) || std::abs(before) < margin(baseline)) {
                continue;
            }
            const glm::vec3 at = after.p(i);
            if (end.distance > 0.0F) {
                ++free;
                ASSERT_EQ(after.contact(i), Contact::kNone) << i << ": " << end.distance;
                ASSERT_LT(glm::distance(at, to), 1e-5F) << i;
            } else if (before > 0.0F) {
                ++hit;
                ASSERT_EQ(after.contact(i), Contact::kCollided) << i << ": " << end.distance;
                ASSERT_LT(glm::distance(at, birth.position), 1e-5F) << i;
            } else {
                ++caught;
                ASSERT_EQ(after.contact(i), Contact::kCaught) << i << ": " << end.distance;
                // There is no normal without a brick, or where all codes are clamped.
                const float vn = glm::dot(v, end.normal);
                if (end.distance > -0.6F * baseline.atlas.range && std::abs(vn) > 0.05F * glm::length(v)) {
                    ++pushed;
                    const glm::vec3 turned = vn < 0.0F ? v - 2.0F * vn * end.normal : v;
                    off += glm::distance(after.v(i), turned) > 0.05F * glm::length(v) ? 1 : 0;
                }
            }
        }
        EXPECT_GT(free, 20'000U);
        EXPECT_GT(hit, 500U);
        EXPECT_GT(caught, 1'000U);
        EXPECT_GT(pushed, 300U);
        // Gradients jump at voxel borders.
        EXPECT_LE(off, pushed / 50);
    }

    std::unique_ptr<GlContext> context_;  // outlives its objects
    std::unique_ptr<MeshQuery> query_;
    std::unique_ptr<BrickVolume> bricks_;
    std::unique_ptr<DistanceVolume> dense_;
    BenchScene scene_;
};

// Bricks as in Unreal Engine, and a dense volume.
TEST_P(BrickRivalGlTest, ParticlesEndOnTheCpuSide) {
    expectCpuSides(bricks(8));
    expectCpuSides(dense());
}

TEST_P(BrickRivalGlTest, ParticlesAmongTightBricksEndOnTheCpuSide) {
    Baseline baseline = bricks(3);
    expectCpuSides(baseline);
    // More bricks than 16 bits can index.
    constexpr std::uint32_t kIdle = 66'000;  // before those in use
    BrickAtlas& atlas = baseline.atlas;
    const std::size_t idle = kIdle * atlas.nodesOfBrick();
    atlas.codes.insert(atlas.codes.begin(), idle, std::int16_t{0});
    atlas.bytes += idle * atlas.bits / 8;
    for (std::uint32_t& cube : atlas.index) {
        cube += cube >= BrickAtlas::kFirstBrick ? kIdle : 0;
    }
    expectCpuSides(baseline);
}

INSTANTIATE_TEST_SUITE_P(Paths, BrickRivalGlTest, testing::Values(StepPath::kFragment, StepPath::kCompute),
                         pathName);

constexpr std::size_t kPointsWide = 100;
constexpr std::size_t kPoints = kPointsWide * 100;

MeshTree treeOf(const TriangleMesh& mesh) {
    return required(buildMeshTree(mesh.positions, mesh.triangles));
}

glm::vec3 randomIn(const Bounds& box, Pcg32& random) {
    const float x = random.uniform();
    const float y = random.uniform();
    const float z = random.uniform();
    return box.min + glm::vec3(x, y, z) * box.size();
}

/// Returns points in a box, and as many close to the surface, half of those very close.
std::vector<glm::vec3> pointsAbout(const TriangleMesh& mesh, std::size_t count) {
    Pcg32 random(3);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3 p = randomIn(mesh.bounds, random);
        if (i % 2 != 0) {
            const auto t = static_cast<std::uint32_t>(random.uniform() * float(mesh.triangles.size() - 1));
            const auto corners = cornersOf(mesh, t);
            const float v = random.uniform();
            const float w = random.uniform() * (1.0F - v);
            const float off = (i % 4 == 1 ? 1e-2F : 1e-4F) * mesh.bounds.longestSide();
            const glm::vec3 way = randomIn({glm::vec3(-1.0F), glm::vec3(1.0F)}, random);
            p = corners[0] + v * (corners[1] - corners[0]) + w * (corners[2] - corners[0]) + off * way;
        }
        points.push_back(p);
    }
    return points;
}

double bruteDistance(const TriangleMesh& mesh, const glm::dvec3& p) {
    double least = 1e300;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [a, b, c] = cornersOf(mesh, t);
        least = std::min(least,
                         glm::distance(p, closestOnTriangle(p, glm::dvec3(a), glm::dvec3(b), glm::dvec3(c))));
    }
    return least;
}

/// A closed mesh of thorns and clefts around the origin, whose vertices have acute edges and saddles.
TriangleMesh makeThorns() {
    Pcg32 random(11);
    return test::moved(test::makeIcosphere({0.0, 0.0, 0.0}, 1.0, 3),
                       [&](const glm::dvec3& p) { return p * (0.3 + 1.4 * double{random.uniform()}); });
}

/// Triangles of all sizes that intersect.
TriangleMesh makeSoup() {
    Pcg32 random(5);
    const Bounds box{glm::vec3(-1.0F), glm::vec3(1.0F)};
    std::vector<glm::vec3> positions;
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t i = 0; i < 700; ++i) {
        const glm::vec3 at = randomIn(box, random);
        const float size = std::pow(10.0F, -3.0F * random.uniform());
        for (int k = 0; k < 3; ++k) {
            positions.push_back(at + size * randomIn(box, random));
        }
        triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    }
    return test::finished(positions, triangles);
}

class MeshRivalGlTest : public testing::Test {
  protected:
    void SetUp() override { context_ = required(GlContext::create(GlApi::kGl33Core)); }

    /// Returns normals and signed distances, one per point.
    static std::vector<glm::vec4> fieldAt(const MeshTree& tree, const std::vector<glm::vec3>& points) {
        const Rival rival = required(makeMeshRival(tree));
        const GlProgram program = required(makeScreenProgram("bench/mesh_query.frag", rival.shader.defines));
        const PassState restored;
        const auto rows = static_cast<GLsizei>(points.size() / kPointsWide);
        std::vector<glm::vec4> texels;
        for (const glm::vec3& p : points) {
            texels.emplace_back(p, 0.0F);
        }
        const GlTexture input =
            makeTexture2D(GL_RGBA32F, kPointsWide, rows, GL_RGBA, GL_FLOAT, texels.data());
        program.use();
        int unit = 0;
        for (const Rival::Texture& texture : rival.textures) {
            useTexture(unit, texture.texture);
            program.set(texture.sampler, unit++);
        }
        useTexture(unit, input);
        program.set("u_points", unit);
        const std::vector<float> floats = drawnFloats(program, kPointsWide, rows);
        for (std::size_t i = 0; i < texels.size(); ++i) {
            texels[i] = {floats[4 * i], floats[4 * i + 1], floats[4 * i + 2], floats[4 * i + 3]};
        }
        return texels;
    }

    static void expectBruteDistances(const TriangleMesh& mesh) {
        const std::vector<glm::vec3> points = pointsAbout(mesh, kPoints);
        const std::vector<glm::vec4> field = fieldAt(treeOf(mesh), points);
        const double rounding = 1e-6 * double{mesh.bounds.longestSide()};
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_NEAR(std::abs(field[i].w), bruteDistance(mesh, glm::dvec3(points[i])), rounding) << i;
        }
    }

    /// Points at rounding distance from the surface have no side.
    static void expectWoundSides(const TriangleMesh& mesh, std::size_t count) {
        const MeshTree tree = treeOf(mesh);
        EXPECT_EQ(tree.open_edges, 0U);
        const std::vector<glm::vec3> points = pointsAbout(mesh, count);
        const std::vector<glm::vec4> field = fieldAt(tree, points);
        const float rounding = 1e-6F * mesh.bounds.longestSide();
        std::size_t inside = 0, compared = 0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (std::abs(field[i].w) > rounding) {
                const bool wound = windingNumber(mesh.positions, mesh.triangles, glm::dvec3(points[i])) > 0.5;
                ASSERT_EQ(field[i].w < 0.0F, wound) << i << ": " << field[i].w;
                inside += wound ? 1 : 0;
                ++compared;
            }
        }
        EXPECT_GT(compared, count / 10 * 9);
        EXPECT_GT(inside, count / 20);
    }

    std::unique_ptr<GlContext> context_;  // outlives its objects
};

// A child's box that is too small, or a wrong reference, prunes the closest triangle.
TEST_F(MeshRivalGlTest, DistancesAreThoseOfBruteForce) {
    expectBruteDistances(makeSoup());
    expectBruteDistances(makeThorns());
    expectBruteDistances(test::makeBoxMesh({1.0, 2.0, 3.0}, {1.0, 0.1, 2.0}));  // a tree of few nodes
    expectBruteDistances(test::finished({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
}

TEST_F(MeshRivalGlTest, DistancesAndSidesOfASphereAreItsOwn) {
    const TriangleMesh sphere = test::makeIcosphere({0.1, 0.2, 0.3}, 1.0, 5);
    constexpr float kSag = 1e-3F;  // of the largest triangle
    Pcg32 random(2);
    std::vector<glm::vec3> points;
    for (std::size_t i = 0; i < kPoints; ++i) {
        points.push_back(randomIn(sphere.bounds, random));
    }
    const std::vector<glm::vec4> field = fieldAt(treeOf(sphere), points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::vec3 from = points[i] - glm::vec3(0.1F, 0.2F, 0.3F);
        const float radius = glm::length(from);
        ASSERT_NEAR(field[i].w, radius - 1.0F, kSag) << i;
        if (std::abs(radius - 1.0F) > 0.1F && radius > 0.1F) {
            ASSERT_GT(glm::dot(glm::vec3(field[i]), from / radius), 0.99F) << i;
        }
    }
}

// Fails with the normals of faces, and with means of normals that are not weighted by angle.
TEST_F(MeshRivalGlTest, SidesAmongThornsAreThoseOfWindingNumbers) {
    expectWoundSides(makeThorns(), kPoints);
}

TEST_F(MeshRivalGlTest, SidesOfTheBunnyAreThoseOfWindingNumbers) {
    expectWoundSides(required(importMesh("/usr/share/glmark2/models/bunny.obj")), 1000);
}

TEST(MeshTreeTest, MergesVerticesAndReportsOpenEdges) {
    const TriangleMesh box = test::makeBoxMesh({0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
    std::vector<glm::vec3> positions;  // three of its own per triangle
    std::vector<glm::uvec3> triangles;
    for (std::uint32_t t = 0; t < box.triangles.size(); ++t) {
        for (const glm::vec3& corner : cornersOf(box, t)) {
            positions.push_back(corner);
        }
        triangles.emplace_back(3 * t, 3 * t + 1, 3 * t + 2);
    }
    const MeshTree closed = required(buildMeshTree(positions, triangles));
    EXPECT_EQ(closed.open_edges, 0U);
    EXPECT_EQ(closed.normals.size(), 8U);
    EXPECT_NEAR(std::abs(closed.normals[0].x), std::sqrt(1.0F / 3.0F), 1e-6F);  // of a corner of a cube
    triangles.pop_back();
    EXPECT_EQ(required(buildMeshTree(positions, triangles)).open_edges, 3U);
    EXPECT_EQ(buildMeshTree(positions, std::vector{glm::uvec3(0, 0, 1)}).error().code,
              ErrorCode::kInvalidInput);
}

class MeshStepGlTest : public testing::TestWithParam<StepPath> {};

// The exact rival makes the step of patches: particles that touch nothing move alike, those born outside stay outside.
TEST_P(MeshStepGlTest, ParticlesMoveAsAmongPatches) {
    constexpr std::uint32_t kCount = 8 * 1024;
    constexpr int kSteps = 100;
    const auto context = required(GlContext::create(GlApi::kGl33Core));
    const glm::dmat3 turn = test::rotation({1, 2, 3}, 40.0);
    const MeshQuery query =
        required(MeshQuery::build(test::joined({test::makeTorusMesh(1.0, 0.35, 96, 48),
                                                test::makeBoxMesh({0.1, 0.2, 1.9}, {0.9, 0.3, 0.2}, turn)})));
    const BenchScene scene =
        makeBenchScene(test::bakeSpecs(query.prepared(), {"patches:budget=200000"}), kCount);
    const MeshTree tree = treeOf(query.mesh());
    BenchSystem patches = required(makeBenchSystem(scene, GetParam()));
    RivalStep exact = required(RivalStep::create(required(makeMeshRival(tree)), scene, GetParam()));
    RivalStep kept = required(RivalStep::create(required(makeMeshRival(tree, true)), scene, GetParam()));
    patches.begin(scene);
    exact.begin(scene);
    kept.begin(scene);
    for (int i = 1; i < kSteps; ++i) {
        patches.step();
        exact.step();
        kept.step();
    }
    const State ours(patches.particles->positions(), patches.particles->velocities(), kCount);
    const State theirs(exact.positions(), exact.velocities(), kCount);
    const State same(kept.positions(), kept.velocities(), kCount);
    EXPECT_EQ(same.position, theirs.position);
    EXPECT_EQ(same.velocity, theirs.velocity);
    const auto deep = 0.01 * double{scene.side};
    std::size_t free = 0, differ = 0, inside_ours = 0, inside_theirs = 0, deep_theirs = 0, leaked = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
        if (!ours.touched(i) && !theirs.touched(i)) {
            ++free;
            differ += ours.p(i) != theirs.p(i) ? 1 : 0;
        }
        const double distance = query.signedDistance(theirs.p(i));
        inside_ours += query.signedDistance(ours.p(i)) < 0.0 ? 1 : 0;
        inside_theirs += distance < 0.0 ? 1 : 0;
        deep_theirs += distance < -deep ? 1 : 0;
        leaked +=
            distance < -1e-6 * double{scene.side} && query.signedDistance(scene.births[i].position) > 0.0 ? 1
                                                                                                          : 0;
    }
    EXPECT_GT(free, kCount / 4);
    EXPECT_LT(free, kCount / 10 * 9);
    EXPECT_EQ(differ, 0U);
    EXPECT_EQ(leaked, 0U);
    EXPECT_EQ(deep_theirs, 0U);
    EXPECT_NEAR(static_cast<double>(inside_theirs), static_cast<double>(inside_ours), 0.01 * kCount);
}

INSTANTIATE_TEST_SUITE_P(Paths, MeshStepGlTest, testing::Values(StepPath::kFragment, StepPath::kCompute),
                         pathName);

}  // namespace
}  // namespace relief::test
