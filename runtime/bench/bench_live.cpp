// What a collider that deforms costs: relief-bench-live MESH [PARTICLES] prints JSON. Nothing here is a test.
//
// A twist moves the mesh; its three front-back maps of 256² are rendered before each step. Each part is timed
// alone, as some runs of it between two glFinish, by the clock on the wall; parts take turns.
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "runtime/bench/bench_tool.h"
#include "runtime/bench/bench_variants.h"
#include "runtime/collider/deform_pass.h"
#include "runtime/collider/live_collider.h"
#include "runtime/files/mesh_file.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {
namespace {

constexpr int kRuns = 16;
constexpr int kRounds = 9;

struct Part {
    std::string name;
    std::function<Result<void>()> run;
    std::vector<double> ms;
};

Result<void> measure(std::vector<Part>& parts) {
    for (int round = -1; round < kRounds; ++round) {  // the first for the driver, which compiles
        for (Part& part : parts) {
            glFinish();
            const Stopwatch watch;
            for (int i = 0; i < kRuns; ++i) {
                RELIEF_TRY(part.run());
            }
            glFinish();
            const double ms = watch.ms();
            if (round >= 0) {
                part.ms.push_back(ms / kRuns);
            }
        }
    }
    return {};
}

/// A twist about the upright through the mesh's middle.
Deformation twistOf(const PictureMesh& mesh) {
    Bounds bounds;
    for (const glm::vec3& p : mesh.positions) {
        bounds.add(p);
    }
    Deformation twist;
    twist.amplitude = 0.3F;
    twist.center = bounds.center();
    twist.range_low = bounds.min.y - twist.center.y;
    twist.range_high = bounds.max.y - twist.center.y;
    return twist;
}

/// Everybody born in the collider's box, and for good.
Result<ParticleSystem> makeParticles(const Collider& frames, const ColliderTextures& textures,
                                     std::uint32_t count) {
    auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = StepPath::kFragment}));
    RELIEF_TRY(particles.setCollider(&textures));
    BenchScene scene = makeBenchScene(frames, count);
    for (Birth& birth : scene.births) {
        birth.lifetime = 1e6F;
    }
    RELIEF_TRY(particles.setForces(scene.forces));
    particles.spawn(scene.births);
    return particles;
}

Result<Json> bench(const std::string& path, std::uint32_t count) {
    const auto file = RELIEF_TRY(loadPictureMesh(path));
    const auto context = RELIEF_TRY(GlContext::create({}));
    const PictureMesh mesh = withNormals(file, 4.0F);
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    const Deformation twist = twistOf(mesh);
    auto frames = RELIEF_TRY(liveFrames(deformedBounds(twist, mesh.positions)));
    auto live = RELIEF_TRY(LiveCollider::create(mesh.positions, triangles, frames));
    auto pass = RELIEF_TRY(DeformPass::create(twist, mesh.positions, mesh.normals));
    auto gpu_mesh = RELIEF_TRY(GpuMesh::create(mesh.positions, triangles, {.keep_previous = true}));
    ColliderBody body;
    body.collider = &live.frames();
    body.live = true;
    auto textures = RELIEF_TRY(ColliderTextures::create({&body, 1}));
    auto particles = RELIEF_TRY(makeParticles(live.frames(), textures, count));

    double time = 0.0;
    const auto deform = [&]() -> Result<void> {
        pass.run(time += kBenchDt);
        return {};
    };
    std::vector<Part> parts{{"deform", deform, {}},
                            {"positions", [&] { return gpu_mesh.setPositions(pass.buffer().name()); }, {}},
                            {"update",
                             [&]() -> Result<void> {
                                 RELIEF_TRY(live.setPositions(pass.buffer().name()));
                                 return live.update(textures, 0);
                             },
                             {}},
                            {"step",
                             [&]() -> Result<void> {
                                 particles.step(kBenchDt);
                                 return {};
                             },
                             {}},
                            {"all", {}, {}}};
    parts.back().run = [&]() -> Result<void> {
        for (const std::size_t i : {0, 2, 3}) {
            RELIEF_TRY(parts[i].run());
        }
        return {};
    };
    RELIEF_TRY(measure(parts));
    Json json{{"device", context->description()},
              {"triangles", triangles.size()},
              {"vertices", mesh.positions.size()},
              {"particles", count}};
    for (const Part& part : parts) {
        json["ms"][part.name] = median(part.ms);
    }
    return json;
}

Result<Json> bench(int argc, char** argv) {
    if (argc != 2 && argc != 3) {
        return fail(ErrorCode::kUsage, "usage: relief-bench-live MESH (.obj or .ply) [PARTICLES]");
    }
    const long count = argc == 3 ? std::strtol(argv[2], nullptr, 10) : 1L << 18;
    if (count < 1 || count > 1L << 24) {
        return fail(ErrorCode::kUsage, "PARTICLES must be from 1 to 16777216");
    }
    return bench(argv[1], static_cast<std::uint32_t>(count));
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-live", relief::bench(argc, argv));
}
