// SPDX-License-Identifier: Apache-2.0
// Benchmark: a collider that plays its first clip.
#include <memory>
#include <nlohmann/json.hpp>

#include "formats/container.h"
#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/live/animated_collider.h"

namespace relief {

/// Poses the mesh and draws its three front-back maps before each step.
Result<Json> benchAnimated(const Bench& bench) {
    const Collider container = RELIEF_TRY(loadCollider(bench.file));
    const auto mesh = std::make_shared<const AnimatedMesh>(RELIEF_TRY(readAnimatedMesh(container.animation)));
    if (mesh->clips.empty()) {
        return fail(ErrorCode::kUsage, "the container has no clip; bake it with --clips");
    }
    const MeshClip& clip = mesh->clips.front();
    Json tables = Json::array();
    for (const std::uint32_t resolution : {384U, 512U}) {
        auto animated =
            RELIEF_TRY(AnimatedCollider::create(mesh, {.resolution = resolution, .box_size = {}}));
        ColliderBody body;
        body.collider = &animated.frames();
        body.pose = animated.placed({});
        body.live = true;
        auto textures = RELIEF_TRY(WorldTextures::create({&body, 1}));
        const std::uint32_t count = bench.particlesOr(1U << 20, 1U << 18);
        const BenchScene scene = makeBenchScene(animated.frames(), count);
        auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = bench.path}));
        RELIEF_TRY(particles.setCollider(&textures));
        RELIEF_TRY(particles.setForces(scene.forces));
        particles.spawn(scene.births);
        double time = 0.0;
        const auto draw = [&]() -> Result<void> {
            time += double{kBenchDt};
            RELIEF_TRY(animated.setPose(poseAt(*mesh, clip, repeated(clip, time))));
            const Pose placed = animated.placed({});
            textures.setPoses({&placed, 1});
            return animated.update(textures, 0);
        };
        const auto step = [&]() -> Result<void> {
            particles.step(kBenchDt);
            return {};
        };
        const auto all = [&]() -> Result<void> {
            RELIEF_TRY(draw());
            return step();
        };
        const std::vector<Work> works{{"pose and draw", draw}, {"step", step}, {"all", all}};
        tables.push_back({{"triangles", mesh->triangles.size()},
                          {"joints", mesh->joints.size()},
                          {"resolution", resolution},
                          {"particles", count},
                          {"rows", RELIEF_TRY(timeInTurns(bench, works, {.rounds = 9}))}});
    }
    return tables;
}

}  // namespace relief
