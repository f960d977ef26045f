// SPDX-License-Identifier: Apache-2.0
// The GPU's maps of a mesh that plays its clips, against the solid of the mesh that the CPU has posed. RELIEF_ANIMATED names a
// container of one's own: every frame of every clip, at 30 a second.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <glm/glm.hpp>
#include <iostream>
#include <memory>
#include <vector>

#include "bake/mesh/inside.h"
#include "bake/mesh/mesh_query.h"
#include "formats/container.h"
#include "runtime/collider/animated_collider.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief {
namespace {

constexpr std::size_t kPoints = 2000;
constexpr double kWrongMax = 0.02;

/// The posed mesh. Its inside is where the surface winds about a point, so that shells may overlap.
class PosedSolid {
  public:
    PosedSolid(std::vector<glm::vec3> positions, const std::vector<glm::uvec3>& triangles) {
        TriangleMesh mesh;
        mesh.positions = std::move(positions);
        mesh.triangles = triangles;
        for (const glm::vec3& p : mesh.positions) {
            mesh.bounds.add(p);
        }
        query_ = std::make_unique<MeshQuery>(MeshQuery::build(PreparedMesh(std::move(mesh))).value());
    }
    /// By two of three lines.
    [[nodiscard]] bool inside(const glm::vec3& p) const {
        int votes = 0;
        std::vector<LineHit> hits;
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3& direction = kParityDirections[i];
            query_->hitsAlong(p, direction, hits);
            int winding = 0;
            for (const LineHit& hit : hits) {
                const glm::uvec3& t = query_->mesh().triangles[hit.triangle];
                const glm::dvec3 a = query_->mesh().positions[t.x];
                const glm::dvec3 b = query_->mesh().positions[t.y];
                const glm::dvec3 c = query_->mesh().positions[t.z];
                const double leaves = glm::dot(glm::cross(b - a, c - a), direction);
                winding += hit.at <= 0.0 ? 0 : leaves > 0.0 ? 1 : -1;
            }
            votes += winding > 0 ? 1 : 0;
        }
        return votes >= 2;
    }
    [[nodiscard]] const TriangleMesh& mesh() const { return query_->mesh(); }

  private:
    std::unique_ptr<MeshQuery> query_;
};

class AnimatedAccuracyGlTest : public GlTest {
  protected:
    void measure(const AnimatedMesh& mesh, double frames_a_second,
                 const AnimatedColliderOptions& options = {}) {
        const auto shared = std::make_shared<const AnimatedMesh>(mesh);
        AnimatedCollider animated = AnimatedCollider::create(shared, options).value();
        const ColliderBody body{.collider = &animated.frames(), .live = true};
        ColliderTextures textures = ColliderTextures::create({&body, 1}).value();
        const FieldQuery query = FieldQuery::create(textures).value();
        for (const MeshClip& clip : mesh.clips) {
            double sum = 0.0;
            double worst = 0.0;
            int frames = 0;
            for (double time = 0.0; time <= double{clip.seconds}; time += 1.0 / frames_a_second, ++frames) {
                const MeshPose pose = poseAt(mesh, clip, time);
                ASSERT_TRUE(animated.setPose(pose));
                const Pose placed = animated.placed({});
                textures.setPoses({&placed, 1});
                ASSERT_TRUE(animated.update(textures, 0));
                const PosedSolid solid(posed(mesh, pose), mesh.triangles);
                const std::vector<glm::vec3> points =
                    pointsNear(solid.mesh().positions, solid.mesh().triangles, kPoints,
                               solid.mesh().bounds.longestSide(), static_cast<std::uint32_t>(frames));
                const std::vector<FieldSample> samples = query.evaluate(points).value();
                std::size_t wrong = 0;
                for (std::size_t i = 0; i < kPoints; ++i) {
                    wrong += samples[i].inside() == solid.inside(points[i]) ? 0 : 1;
                }
                const double share = static_cast<double>(wrong) / static_cast<double>(kPoints);
                EXPECT_LE(share, kWrongMax) << clip.name << " at " << time;
                sum += share;
                worst = std::max(worst, share);
            }
            std::cout << clip.name << ": " << frames << " frames, " << 100.0 * sum / frames
                      << " % wrong, the worst " << 100.0 * worst << " %\n";
        }
    }
};
INSTANTIATE_TEST_SUITE_P(Api, AnimatedAccuracyGlTest, testing::Values(GlApi::kGl33Core), glApiTestName);

TEST_P(AnimatedAccuracyGlTest, FewPointsAreOnTheWrongSide) {
    const char* file = std::getenv("RELIEF_ANIMATED");
    if (file == nullptr) {
        // Thin: a twenty-fifth of the box, with half a texel lost at its silhouettes.
        measure(bendingTube(), 5.0, {.resolution = 768, .room = {}});
        return;
    }
    measure(readAnimatedMesh(loadCollider(file).value().animation).value(), 30.0);
}

}  // namespace
}  // namespace relief
