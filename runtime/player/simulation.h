// What moves in a scene: emitters, particles and colliders, on the GPU and stepped together.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/stage_timer.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_system.h"
#include "runtime/player/live_bodies.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/tool/watchdog.h"

namespace relief {

class Simulation {
  public:
    /// Needs a current context, as step() does.
    /// \param loaded    must outlive this.
    /// \param path      of the particles' steps.
    /// \param watchdog  may be null.
    /// Fails as ColliderTextures, LiveBodies and ParticleSystem do. An error of the textures names the scene's
    /// first collider.
    [[nodiscard]] static Result<Simulation> create(const LoadedScene& loaded, std::vector<Emitter> emitters,
                                                   StepPath path, Watchdog* watchdog);

    /// Births, then the colliders' poses and shapes at the step's end, then the particles' step.
    /// \param stages  times births and step; may be null.
    /// Fails as LiveBodies::show does.
    [[nodiscard]] Result<void> step(StageTimer* stages);

    [[nodiscard]] const ParticleSystem& particles() const { return *particles_; }
    [[nodiscard]] const ColliderTextures& textures() const { return *textures_; }
    /// Births that emitters did not ask the particle system for, as it had no room.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }

  private:
    Simulation() = default;
    void giveBirth();
    [[nodiscard]] Result<void> moveColliders(double time);

    const Scene* scene_ = nullptr;
    bool poses_change_ = false;
    std::vector<Emitter> emitters_;
    std::unique_ptr<ColliderTextures> textures_;  // at one place: the particles point to it
    LiveBodies live_;
    std::unique_ptr<ParticleSystem> particles_;
    std::vector<Birth> births_;  // of a step, kept for its memory
    std::uint64_t refused_ = 0;
};

}  // namespace relief
