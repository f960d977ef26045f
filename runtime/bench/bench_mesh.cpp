// SPDX-License-Identifier: Apache-2.0
// Benchmark: a collider that deforms in waves.
#include "runtime/bench/bench.h"

#include <nlohmann/json.hpp>
#include "runtime/bench/bench_scene.h"
#include "runtime/files/mesh_file.h"
#include "runtime/live/live_collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/picture/collider_mesh.h"

namespace relief {

/// Deforms the mesh and draws its three front-back maps of 256² before each step.
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
    const Collider frames = RELIEF_TRY(liveFrames(box));
    auto live = RELIEF_TRY(LiveCollider::create(mesh.positions, triangles, frames));
    auto pass = RELIEF_TRY(WobblePass::create(wobble, mesh.positions, mesh.normals));
    ColliderBody body;
    body.collider = &live.frames();
    body.live = true;
    auto textures = RELIEF_TRY(WorldTextures::create({&body, 1}));
    const std::uint32_t count = bench.particlesOr(1U << 18, 1U << 18);
    const BenchScene scene = makeBenchScene(live.frames(), count);
    auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = bench.path}));
    RELIEF_TRY(particles.setCollider(&textures));
    RELIEF_TRY(particles.setForces(scene.forces));
    particles.spawn(scene.births);
    double time = 0.0;
    const auto deform = [&]() -> Result<void> {
        pass.run(time += kBenchDt);
        return {};
    };
    const auto update = [&]() -> Result<void> {
        RELIEF_TRY(live.setPositions(pass.buffer().name()));
        return live.update(textures, 0);
    };
    const auto step = [&]() -> Result<void> {
        particles.step(kBenchDt);
        return {};
    };
    const auto all = [&]() -> Result<void> {
        RELIEF_TRY(deform());
        RELIEF_TRY(update());
        return step();
    };
    const std::vector<Work> works{{"deform", deform}, {"update", update}, {"step", step}, {"all", all}};
    return Json{{{"triangles", triangles.size()},
                 {"particles", count},
                 {"rows", RELIEF_TRY(timeInTurns(bench, works, {.rounds = 9}))}}};
}

}  // namespace relief
