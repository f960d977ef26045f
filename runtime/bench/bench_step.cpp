// SPDX-License-Identifier: Apache-2.0
// Benchmark: the cost of a step relative to a copy of the state, and the cost of each feature. All particles are
// respawned before each block, so that blocks are equal; births and the first step are not timed.
//
// `copy` is a draw (a dispatch on the compute path) that only copies the two state textures: it reads and writes 32
// bytes per particle. A step also reads the 16 bytes of the birth texture.
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "formats/base/file_io.h"
#include "formats/base/stopwatch.h"
#include "formats/container.h"
#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/bench/rival_step.h"
#include "runtime/files/mesh_file.h"
#include "runtime/gl/compute_units.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/particles/random.h"
#include "shaders/particles/constants.h"

namespace relief {
namespace {

constexpr double kWarmUpMs = 100.0;

/// Copies two state textures.
class Copy {
  public:
    static Result<Copy> create(std::uint32_t particles, StepPath path) {
        Copy copy;
        copy.compute_ = path == StepPath::kCompute;
        copy.rows_ = static_cast<GLsizei>(particles / ParticleSystem::kStateWidth);
        Pcg32 random(1);
        std::vector<float> texels(std::size_t{4} * particles);  // incompressible
        std::generate(texels.begin(), texels.end(), [&] { return random.uniform(); });
        for (std::size_t i = 0; i < 2; ++i) {
            for (GlTexture& texture : copy.state_[i]) {
                texture = makeTexture2D(GL_RGBA32F, kWidth, copy.rows_, GL_RGBA, GL_FLOAT, texels.data());
            }
            copy.target_[i] =
                RELIEF_TRY(makeFramebuffer({copy.state_[i][0].name(), copy.state_[i][1].name()}));
        }
        copy.program_ = RELIEF_TRY(copy.compute_ ? makeComputeProgram("bench/copy_state.frag")
                                                 : makeScreenProgram("bench/copy_state.frag"));
        copy.program_.use();
        copy.program_.set("u_velocity", 1);
        glUseProgram(0);
        return copy;
    }
    void step() {
        const std::size_t next = 1 - current_;
        for (std::size_t i = 0; i < 2; ++i) {
            useTexture(static_cast<int>(i), state_[current_][i]);
        }
        glUseProgram(program_.name());
        if (compute_) {
            ImageUnits::write(0, state_[next][0]);
            ImageUnits::write(1, state_[next][1]);
            // Writes beyond the last row are discarded.
            glDispatchCompute(kWidth / kStepGroupWidth,
                              static_cast<GLuint>((rows_ + kStepGroupHeight - 1) / kStepGroupHeight), 1);
            ImageUnits::finish();
        } else {
            program_.drawScreen(target_[next].name(), kWidth, rows_);
        }
        glUseProgram(0);  // so that PassState does not save it
        current_ = next;
    }

  private:
    static constexpr auto kWidth = static_cast<GLsizei>(ParticleSystem::kStateWidth);

    bool compute_ = false;
    GLsizei rows_ = 0;
    std::size_t current_ = 0;
    std::array<std::array<GlTexture, 2>, 2> state_;  // position and velocity
    std::array<GlFramebuffer, 2> target_;
    GlProgram program_;
};

/// A rival of the collider.
struct Baseline {
    std::string name;
    RivalStep step;
    Json facts;  // reported with its size
};

/// Checks that a file was made of the mesh of the collider.
Result<void> checkBox(const std::string& file, const Bounds& box, const BenchScene& scene) {
    const glm::vec3 apart = glm::abs(box.center() - scene.collider.bounds.center());
    if (glm::any(glm::greaterThan(apart, glm::vec3(0.05F * scene.side)))) {
        return fail(ErrorCode::kUsage,
                    quotedPath(file) +
                        " was made from a different mesh than the collider; make both from the same mesh");
    }
    return {};
}

Result<Baseline> brickBaseline(const std::string& file, const Bench& bench, const BenchScene& scene) {
    const BrickAtlas atlas = RELIEF_TRY(loadBrickAtlas(file));
    RELIEF_TRY(checkBox(file, atlas.box, scene));
    Rival rival = RELIEF_TRY(makeBrickRival(atlas));
    return Baseline{std::filesystem::path(file).stem().string(),
                    RELIEF_TRY(RivalStep::create(std::move(rival), scene, bench.path)), Json::object()};
}

/// Appends "exact", which queries the mesh in every step, and "exact_kept", which keeps distances between steps.
Result<void> addExact(std::vector<Baseline>& baselines, const Bench& bench, const BenchScene& scene) {
    const PictureMesh mesh = RELIEF_TRY(loadPictureMesh(bench.exact));
    const Stopwatch watch;
    const MeshTree tree =
        RELIEF_TRY(withPrefix(quotedPath(bench.exact), buildMeshTree(mesh.positions, trianglesOf(mesh))));
    const Json facts = {{"triangles", tree.triangles.size() / MeshTree::kTexels},
                        {"nodes", tree.nodes.size() / MeshTree::kTexels},
                        {"open_edges", tree.open_edges},
                        {"build_ms", watch.ms()}};
    RELIEF_TRY(checkBox(bench.exact, tree.box, scene));
    for (const bool keeps : {false, true}) {
        Rival rival = RELIEF_TRY(makeMeshRival(tree, keeps));
        baselines.push_back({keeps ? "exact_kept" : "exact",
                             RELIEF_TRY(RivalStep::create(std::move(rival), scene, bench.path)), facts});
    }
    return {};
}

Result<std::vector<Baseline>> baselinesFor(const Bench& bench, const BenchScene& scene) {
    std::vector<Baseline> baselines;
    for (const std::string& file : bench.bricks) {
        baselines.push_back(RELIEF_TRY(brickBaseline(file, bench, scene)));
    }
    if (!bench.exact.empty()) {
        RELIEF_TRY(addExact(baselines, bench, scene));
    }
    return baselines;
}

Work workOf(Baseline& baseline, const BenchScene& scene, const std::function<void()>& warm) {
    return {baseline.name,
            [&baseline]() -> Result<void> {
                baseline.step.step();
                return {};
            },
            "collider",
            [&baseline, &scene, warm] {
                warm();
                baseline.step.begin(scene);
            }};
}

Json factsOf(const std::vector<Baseline>& baselines) {
    Json all = Json::object();
    for (const Baseline& baseline : baselines) {
        Json& facts = all[baseline.name] = {{"bytes", baseline.step.bytes()}};
        facts.update(baseline.facts);
    }
    return all;
}

/// Returns the requested variant and those that it is compared with.
Result<std::vector<BenchVariant>> variantsFor(const std::string& only,
                                              const std::vector<Baseline>& baselines) {
    std::vector<BenchVariant> variants = benchVariants();
    const auto named = [&](const auto& variant) { return variant.name == only; };
    if (!only.empty() && std::ranges::none_of(variants, named) && std::ranges::none_of(baselines, named)) {
        return fail(ErrorCode::kUsage, "--only " + only + ": no such variant; omit it to run all");
    }
    std::erase_if(variants, [&](const BenchVariant& variant) {
        return !only.empty() && !named(variant) && variant.name != "collider" &&
               variant.name != "no_collider";
    });
    return variants;
}

/// Returns the reference of a variant: "copy" for "no_collider", "no_collider" for "collider", "collider" for the rest.
std::string comparedWith(const std::string& variant) {
    return variant == "no_collider" ? "copy" : variant == "collider" ? "no_collider" : "collider";
}

}  // namespace

Result<Json> benchStep(const Bench& bench) {
    const std::uint32_t count = bench.particlesOr(1U << 20, 1U << 17);
    if (count % ParticleSystem::kStateWidth != 0) {
        return fail(ErrorCode::kUsage, "--particles must be a multiple of " +
                                           std::to_string(ParticleSystem::kStateWidth) + " for step");
    }
    const BenchScene scene = makeBenchScene(RELIEF_TRY(loadCollider(bench.file)), count, kBenchLifetime);
    std::vector<Baseline> baselines = RELIEF_TRY(baselinesFor(bench, scene));
    const std::vector<BenchVariant> variants = RELIEF_TRY(variantsFor(bench.only, baselines));
    const int steps = bench.software ? 4 : kBenchStepsMax;
    auto copy = RELIEF_TRY(Copy::create(count, bench.path));
    const auto copies = [&] {
        for (int i = 0; i < kBenchStepsMax; ++i) {
            copy.step();
        }
    };
    const auto warm = [&] { warmUp(bench, kWarmUpMs, copies); };
    std::vector<Work> works{{.name = "copy",
                             .run = [&]() -> Result<void> {
                                 copy.step();
                                 return {};
                             },
                             .before = warm}};
    std::vector<BenchSystem> systems(variants.size());
    for (std::size_t i = 0; i < variants.size(); ++i) {
        BenchSystem& system = systems[i] = RELIEF_TRY(makeBenchSystem(scene, bench.path, variants[i]));
        works.push_back(
            {variants[i].name,
             [&system]() -> Result<void> {
                 system.step();
                 return {};
             },
             comparedWith(variants[i].name),
             [&] {
                 warm();
                 system.begin(scene);
             },
             [&system] { system.particles->step(2.0F * kBenchLifetime); }});  // kills all particles
    }
    for (Baseline& baseline : baselines) {
        works.push_back(workOf(baseline, scene, warm));
    }
    const int rounds = bench.software ? 5 : count > (1U << 20) ? 3 : 11;
    return Json{{{"particles", count},
                 {"maps", scene.collider.maps.size()},
                 {"steps", steps},
                 {"rivals", factsOf(baselines)},
                 {"rows", RELIEF_TRY(timeAlternating(bench, works, {.rounds = rounds, .calls = steps}))}}};
}

}  // namespace relief
