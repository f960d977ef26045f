#include "runtime/player/simulation.h"

#include <algorithm>
#include <span>
#include <utility>

#include "formats/base/error_context.h"
#include "formats/base/file_io.h"
#include "runtime/player/watched.h"

namespace relief {
namespace {

/// The colliders on the GPU: a single one without a pose in its own space, others in the world.
Result<ColliderTextures> makeTextures(const Scene& scene, std::span<const Collider> colliders) {
    const SceneCollider& first = scene.colliders.front();
    if (colliders.size() == 1 && !first.posed && !first.live) {
        return ColliderTextures::create(colliders.front());
    }
    std::vector<ColliderBody> bodies;
    for (std::size_t i = 0; i < colliders.size(); ++i) {
        const SceneCollider& from = scene.colliders[i];
        bodies.push_back(
            {&colliders[i], poseAt(from, 0.0), from.restitution, from.friction, from.live.has_value()});
    }
    return ColliderTextures::create(bodies);
}

Result<ParticleSystem> makeParticles(const Scene& scene, const ColliderTextures& textures, StepPath path) {
    auto particles = RELIEF_TRY(
        ParticleSystem::create({.capacity = scene.capacity, .integrator = scene.integrator, .path = path}));
    RELIEF_TRY(particles.setCollider(&textures));
    particles.setForces({*scene.forces.gravity, scene.forces.wind,
                         scene.air.viscosity ? 0.0F : scene.forces.drag, scene.air.viscosity.value_or(0.0F)});
    particles.setCollision(scene.collision);
    if (!scene.types.empty()) {
        RELIEF_TRY(particles.setTypes(scene.types));
    }
    if (scene.sweep > 0.0F) {
        RELIEF_TRY(particles.setSweep(scene.sweep));
    }
    RELIEF_TRY(particles.setAir(scene.air));
    particles.setGround(scene.ground.enabled ? scene.ground.height : std::nullopt);
    return particles;
}

std::vector<Pose> posesAt(const Scene& scene, double time) {
    std::vector<Pose> poses;
    for (const SceneCollider& collider : scene.colliders) {
        poses.push_back(poseAt(collider, time));
    }
    return poses;
}

}  // namespace

Result<Simulation> Simulation::create(const LoadedScene& loaded, std::vector<Emitter> emitters, StepPath path,
                                      Watchdog* watchdog) {
    Simulation made;
    const Scene& scene = loaded.scene;
    made.scene_ = &scene;
    made.emitters_ = std::move(emitters);
    made.poses_change_ = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                                     [](const SceneCollider& c) { return !c.keys.empty(); });
    auto textures = RELIEF_TRY(inFront(
        quotedPath(scene.colliders.front().path),
        watched(watchdog, "uploading the collider", [&] { return makeTextures(scene, loaded.colliders); })));
    made.textures_ = std::make_unique<ColliderTextures>(std::move(textures));
    made.live_ =
        RELIEF_TRY(watched(watchdog, "the shaders of colliders", [&] { return LiveBodies::create(loaded); }));
    RELIEF_TRY(watched(watchdog, "the colliders' first maps",
                       [&] { return made.live_.show(0.0, *made.textures_); }));
    auto particles = RELIEF_TRY(watched(watchdog, "the shaders of particles",
                                        [&] { return makeParticles(scene, *made.textures_, path); }));
    made.particles_ = std::make_unique<ParticleSystem>(std::move(particles));
    return made;
}

Result<void> Simulation::step(StageTimer* stages) {
    {
        const StageScope scope(stages, Stage::kBirths);
        giveBirth();
    }
    const StageScope scope(stages, Stage::kStep);
    RELIEF_TRY(moveColliders(particles_->time() + static_cast<double>(scene_->dt)));
    particles_->step(scene_->dt);
    return {};
}

void Simulation::giveBirth() {
    births_.clear();
    refused_ += emitAll(emitters_, static_cast<double>(scene_->dt), particles_->room(), births_);
    particles_->spawn(births_);
}

Result<void> Simulation::moveColliders(double time) {
    if (poses_change_) {
        textures_->setPoses(posesAt(*scene_, time));
    }
    return live_.show(time, *textures_);
}

}  // namespace relief
