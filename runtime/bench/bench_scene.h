// SPDX-License-Identifier: Apache-2.0
// The scene of the cases, and particle systems that differ in a single feature each.
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
inline constexpr int kBenchStepsMost = 16;  ///< of a block
/// Seconds: longer than a block and the step before it, so that no particle dies within.
inline constexpr float kBenchLifetime = 0.5F;
static_assert(kBenchLifetime > kBenchDt * (kBenchStepsMost + 2));
inline constexpr float kBenchForever = 1e6F;  ///< seconds

/// Snow as in samples/, but born all through the collider's box at once: from the first step on there is
/// something to collide with. Types 0…15 in turn; a system with a single type takes them all for that one.
struct BenchScene {
    Collider collider;
    float side = 1.0F;  ///< longest of the bounds, object units
    Forces forces;
    std::vector<Birth> births;
};

[[nodiscard]] BenchScene makeBenchScene(Collider collider, std::uint32_t particles,
                                        float lifetime = kBenchForever);

/// Of the snow, without a radius.
[[nodiscard]] ParticleType benchParticleType();

/// A particle system with what it collides with.
struct BenchSystem {
    std::unique_ptr<WorldTextures> textures;  // stays where it is: the particles point at it
    std::unique_ptr<ParticleSystem> particles;
    std::function<void()> before_step;  // may be empty

    void step();
    /// Everybody born, and a first step, for which the driver compiles.
    void begin(const BenchScene& scene);
};

/// kCrowd: bodies at random turns on a lattice that fills the scene's box, of up to kCrowdColliders copies of the collider.
enum class Solids : std::uint8_t { kNone, kCollider, kFourBodies, kCrowd };
inline constexpr std::size_t kCrowdColliders = 50;
/// Work of each step beside the step: nothing, new poses of the bodies (of a crowd, of at most kCrowdMoves), or lists of
/// events that come to the CPU.
enum class EachStep : std::uint8_t { kNothing, kPoses, kEvents };
inline constexpr std::size_t kCrowdMoves = 1'000;
inline constexpr float kCrowdShare = 0.8F;
/// Boxes of bodies then fill 8 % of the space, as the things of samples/village.py do between ground and roofs.
inline constexpr float kVillageShare = 0.43F;

struct BenchVariant {
    std::string name;
    Solids solids = Solids::kCollider;
    Integrator integrator = Integrator::kEuler;
    std::function<Result<void>(ParticleSystem&, const BenchScene&)> set = {};  ///< may be empty
    EachStep each_step = EachStep::kNothing;
    std::uint32_t bodies = 0;   ///< of a crowd
    float share = kCrowdShare;  ///< of their lattice's spacing, that a body's sides are
};

/// "no_collider", "collider" (what the others are compared with), the features one by one, and crowds of bodies.
[[nodiscard]] std::vector<BenchVariant> benchVariants();

/// The system takes the scene's number of particles. Without a variant: that of "collider".
[[nodiscard]] Result<BenchSystem> makeBenchSystem(const BenchScene& scene, StepPath path,
                                                  const BenchVariant& variant = {});

}  // namespace relief
