// SPDX-License-Identifier: Apache-2.0
// The scene of the benchmark cases, and particle systems that differ by a single feature.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/particles/particle_system.h"

namespace relief {

inline constexpr float kBenchDt = 1.0F / 60.0F;
inline constexpr int kBenchStepsMax = 16;  ///< per block (bench.h)
/// Seconds; longer than a block and the step before it, so that no particle dies meanwhile.
inline constexpr float kBenchLifetime = 0.5F;
static_assert(kBenchLifetime > kBenchDt * (kBenchStepsMax + 2));
inline constexpr float kBenchForever = 1e6F;  ///< seconds

/// Snow as in samples/, but born all at once throughout the collider's bounds, so that particles collide from the first
/// step on. Types 0…15 alternate; a system with a single type uses it for all particles.
struct BenchScene {
    Collider collider;
    float side = 1.0F;  ///< longest side of the bounds, object units
    Forces forces;
    std::vector<Birth> births;
};

[[nodiscard]] BenchScene makeBenchScene(Collider collider, std::uint32_t particles,
                                        float lifetime = kBenchForever);

/// The type of the snow, without a radius.
inline constexpr ParticleType kBenchSnow{.restitution = 0.0F, .friction = 1.0F};

/// A particle system with its colliders.
struct BenchSystem {
    std::unique_ptr<WorldTextures> textures;  // stable address: the particles point to it
    std::unique_ptr<ParticleSystem> particles;
    std::function<void()> before_step;  // may be empty

    void step();
    /// Spawns all particles, and runs a first step for shader compilation.
    void begin(const BenchScene& scene);
};

/// kCrowd: randomly rotated bodies on a lattice in the collider's bounds, which share up to kCrowdColliders copies of
/// the collider.
enum class Solids : std::uint8_t { kNone, kCollider, kFourBodies, kCrowd };
inline constexpr std::size_t kCrowdColliders = 50;
/// Additional work of each step: none, new poses of bodies (at most kCrowdMoves of a crowd), or read-back of events.
enum class EachStep : std::uint8_t { kNothing, kPoses, kEvents };
inline constexpr std::size_t kCrowdMoves = 1'000;
inline constexpr float kCrowdFill = 0.8F;
/// BenchVariant::share at which the bounds of bodies fill 8 % of space, as in samples/village.py between ground and
/// roofs.
inline constexpr float kVillageFill = 0.43F;

struct BenchVariant {
    std::string name;
    Solids solids = Solids::kCollider;
    Integrator integrator = Integrator::kEuler;
    std::function<Result<void>(ParticleSystem&, const BenchScene&)> set = {};  ///< may be empty
    EachStep each_step = EachStep::kNothing;
    std::uint32_t bodies = 0;  ///< number of bodies in a crowd
    float share = kCrowdFill;  ///< side of a body, as a fraction of the lattice spacing
};

/// Returns the variants: "no_collider", "collider" (the reference), one per feature, and crowds of bodies.
[[nodiscard]] std::vector<BenchVariant> benchVariants();

/// Creates a system with room for all births of the scene. Default variant: "collider".
[[nodiscard]] Result<BenchSystem> makeBenchSystem(const BenchScene& scene, StepPath path,
                                                  const BenchVariant& variant = {});

}  // namespace relief
