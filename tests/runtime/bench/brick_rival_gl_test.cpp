// SPDX-License-Identifier: Apache-2.0
// Compares the baseline of relief-bench on the GPU with its volume on the CPU: a comparison with a wrong baseline would
// be worthless.
#include "runtime/bench/brick_rival.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "bake/bench/brick_volume.h"
#include "bake/bench/distance_volume.h"
#include "bake/mesh/mesh_query.h"
#include "runtime/gl/pass_state.h"
#include "tests/bake/meshes.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

constexpr std::uint32_t kParticles = 64 * 1024;

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

    explicit State(const RivalStep& step) {
        const PassState restored;
        constexpr auto kWidth = static_cast<GLsizei>(ParticleSystem::kStateWidth);
        position = readTextureFloats(step.positions(), kWidth, kParticles / kWidth).value();
        velocity = readTextureFloats(step.velocities(), kWidth, kParticles / kWidth).value();
    }
    [[nodiscard]] glm::vec3 p(std::size_t i) const {
        return {position[4 * i], position[4 * i + 1], position[4 * i + 2]};
    }
    [[nodiscard]] glm::vec3 v(std::size_t i) const {
        return {velocity[4 * i], velocity[4 * i + 1], velocity[4 * i + 2]};
    }
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
        auto rival = makeBrickRival(baseline.atlas);
        ASSERT_TRUE(rival) << rival.error().message;
        auto step = RivalStep::create(std::move(*rival), scene_, GetParam());
        ASSERT_TRUE(step) << step.error().message;
        EXPECT_GE(step->bytes(), baseline.atlas.bytes);
        // Except for atlas slots without a brick.
        EXPECT_LE(step->bytes(), baseline.atlas.bytes + baseline.atlas.bytes / 100);
        step->begin(scene_);
        expectCpuReactions(baseline, State(*step));
        for (int i = 0; i < 15; ++i) {
            step->step();
        }
        const State after(*step);
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
                         [](const testing::TestParamInfo<StepPath>& path) {
                             return path.param == StepPath::kCompute ? "Compute" : "Fragment";
                         });

}  // namespace
}  // namespace relief
