// SPDX-License-Identifier: Apache-2.0
// Benchmarks: a collider that deforms in waves, and an animated collider that plays its first clip. The three front-back
// maps of the collider are drawn before each step.
#include <memory>
#include <nlohmann/json.hpp>

#include "formats/container.h"
#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/files/mesh_file.h"
#include "runtime/live/animated_collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/collider_mesh.h"

namespace relief {
namespace {

/// Makes a system whose only collider deforms. \param frames  the collider's maps; must outlive the system.
Result<BenchSystem> deformingSystem(const Bench& bench, const Collider& frames, const Pose& pose,
                                    std::uint32_t count) {
    const ColliderBody body{.collider = &frames, .pose = pose, .live = true};
    const BenchScene scene = makeBenchScene(frames, count);
    BenchSystem system;
    system.textures = std::make_unique<WorldTextures>(RELIEF_TRY(WorldTextures::create({&body, 1})));
    system.particles = std::make_unique<ParticleSystem>(
        RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = bench.path})));
    RELIEF_TRY(system.particles->setCollider(system.textures.get()));
    RELIEF_TRY(system.particles->setForces(scene.forces));
    system.particles->spawn(scene.births);
    return system;
}

/// Times each workload, a step, and all of them together.
Result<Json> timeWithStep(const Bench& bench, std::vector<Work> works, BenchSystem& system) {
    works.push_back({"step", [&] { return system.particles->step(kBenchDt); }});
    const std::vector<Work> parts = works;
    works.push_back({"all", [&]() -> Result<void> {
                         for (const Work& part : parts) {
                             RELIEF_TRY(part.run());
                         }
                         return {};
                     }});
    return timeAlternating(bench, works, {.rounds = 9});
}

}  // namespace

Result<Json> benchMesh(const Bench& bench) {
    const PictureMesh mesh = withNormals(RELIEF_TRY(loadPictureMesh(bench.file)), 4.0F);
    Bounds box;
    for (const glm::vec3& p : mesh.positions) {
        box.add(p);
    }
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    const Wobble wobble{.amplitude = 0.02F * box.longestSide(), .wavelength = 0.5F * box.longestSide()};
    box.min -= wobble.amplitude;
    box.max += wobble.amplitude;
    const Collider frames = RELIEF_TRY(liveMaps(box));
    auto live = RELIEF_TRY(LiveCollider::create(mesh.positions, triangles, frames));
    auto pass = RELIEF_TRY(WobblePass::create(wobble, mesh.positions, mesh.normals));
    const std::uint32_t count = bench.particlesOr(1U << 18, 1U << 18);
    auto system = RELIEF_TRY(deformingSystem(bench, live.frames(), {}, count));
    double time = 0.0;
    const auto deform = [&]() -> Result<void> {
        pass.run(time += kBenchDt);
        return {};
    };
    const auto update = [&]() -> Result<void> {
        RELIEF_TRY(live.setPositions(pass.buffer().name()));
        return live.update(*system.textures, 0);
    };
    return Json{
        {{"triangles", triangles.size()},
         {"particles", count},
         {"rows", RELIEF_TRY(timeWithStep(bench, {{"deform", deform}, {"update", update}}, system))}}};
}

Result<Json> benchAnimated(const Bench& bench) {
    const Collider container = RELIEF_TRY(loadCollider(bench.file));
    const auto mesh = std::make_shared<const AnimatedMesh>(RELIEF_TRY(readAnimatedMesh(container.animation)));
    if (mesh->clips.empty()) {
        return fail(ErrorCode::kUsage, "the container has no clip; bake it with --clips");
    }
    const MeshClip& clip = mesh->clips.front();
    const std::uint32_t count = bench.particlesOr(1U << 20, 1U << 18);
    Json tables = Json::array();
    for (const std::uint32_t resolution : {384U, 512U}) {
        auto animated =
            RELIEF_TRY(AnimatedCollider::create(mesh, {.resolution = resolution, .box_size = {}}));
        auto system = RELIEF_TRY(deformingSystem(bench, animated.frames(), animated.placed({}), count));
        double time = 0.0;
        const auto draw = [&]() -> Result<void> {
            time += double{kBenchDt};
            RELIEF_TRY(animated.setPose(poseAt(*mesh, clip, repeated(clip, time))));
            const Pose placed = animated.placed({});
            system.textures->setPoses({&placed, 1});
            return animated.update(*system.textures, 0);
        };
        tables.push_back({{"triangles", mesh->triangles.size()},
                          {"joints", mesh->joints.size()},
                          {"resolution", resolution},
                          {"particles", count},
                          {"rows", RELIEF_TRY(timeWithStep(bench, {{"pose and draw", draw}}, system))}});
    }
    return tables;
}

}  // namespace relief
