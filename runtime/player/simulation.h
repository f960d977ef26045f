// SPDX-License-Identifier: Apache-2.0
// The moving parts of a scene, emitters, particles and colliders, on the GPU and stepped together.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "formats/base/result.h"
#include "runtime/births/emitter_motion.h"
#include "runtime/births/mesh_trail.h"
#include "runtime/events/event_recorder.h"
#include "runtime/live/animated_collider.h"
#include "runtime/live/live_collider.h"
#include "runtime/live/wobble_pass.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_system.h"
#include "runtime/player/watchdog.h"
#include "runtime/scene/loaded_scene.h"
#include "runtime/stream/world_stream.h"

namespace relief {

struct SimulationOptions {
    StepPath path = StepPath::kAuto;  ///< of the particles' steps
    Watchdog* watchdog = nullptr;     ///< may be null
    /// Called between steps before time 0; what it throws comes out of create(). May be empty.
    std::function<void()> checkpoint = {};
    /// Brings the colliders of a scene with a [stream]. Steps do not wait for it, so that no two runs need be alike, and the
    /// scene's camera does not count. Null: the files beside the world, and each step waits for all that it wants.
    std::unique_ptr<ColliderSource> source = nullptr;
};

class Simulation {
  public:
    /// Needs a current context, as step() does. Plays what comes before time 0 (time.prewarm).
    /// \param loaded  must outlive this.
    /// Fails as WorldTextures, LiveCollider, WobblePass, AnimatedCollider and ParticleSystem do. An error of the textures names the scene's
    /// world, or its first collider.
    [[nodiscard]] static Result<Simulation> create(const LoadedScene& loaded, SimulationOptions options = {});

    /// Births, those of the scene's [[spawn]] by events of the step before the last, then the colliders' poses and shapes
    /// at the step's end, then the particles' step.
    /// Fails as LiveCollider::update and ParticleSystem::step do.
    [[nodiscard]] Result<void> step() { return step(scene_->time.dt); }
    /// \param dt  seconds, > 0, instead of the scene's.
    [[nodiscard]] Result<void> step(float dt);

    /// Takes over the forces, collision, types, air, ground and poses of a scene that was changed since; particles stay.
    /// The scene is that of create(), whose capacity and integrator are as they were, and its colliders but for the poses of
    /// those that share a world. Where a pose has changed, the collider passes from the old one to it during the next step.
    /// \param emitters  instead of those there are; nullopt: these go on.
    /// Fails as ParticleSystem's setters do.
    [[nodiscard]] Result<void> change(std::optional<std::vector<Emitter>> emitters);

    /// Passes on the events of every step from the next one on, in the order of steps; each comes a few steps late, so
    /// that nothing waits for the GPU. The tag is the number of the step, from 1.
    /// It may hold more than new hits: all that the scene's [[spawn]] needs. Up to kEventsMax of a step.
    /// \param min_speed  slower hits may be left out.
    /// Fails as setEvents() does.
    using EventSink = std::function<Result<void>(const StepEvents&)>;
    [[nodiscard]] Result<void> listHits(float min_speed, EventSink sink);
    static constexpr std::uint32_t kEventsMax = 1U << 18;
    /// Passes on the events that are still in flight. Fails as the sink and waitEvents() do.
    [[nodiscard]] Result<void> finishEvents() { return takeEvents(0); }

    /// Births on top of the emitters', with the next step. Returns how many, and fails, as ParticleSystem::spawn does.
    [[nodiscard]] Result<std::size_t> spawn(std::span<const Birth> births);

    [[nodiscard]] const ParticleSystem& particles() const { return *particles_; }
    [[nodiscard]] const WorldTextures& textures() const { return stream_ ? stream_->textures() : *textures_; }
    /// Since the last call: those of the scene (LoadedScene::warnings), and one line for each collider of a streamed world that
    /// could not be loaded.
    [[nodiscard]] std::vector<std::string> takeWarnings();
    /// Births of emitters and [[spawn]] that were dropped because the particle system had no room.
    [[nodiscard]] std::uint64_t refused() const { return refused_; }
    /// Places besides the emitters' where a world that is streamed has full detail, in place of the scene's camera. From the next
    /// step on.
    void setPoints(std::vector<PointOfInterest> points) { points_ = std::move(points); }
    /// A pose of the caller's own for a collider that plays a clip, from the next step on; nullopt: the clip again.
    /// Errors: kUsage (one that plays none, AnimatedCollider::check()).
    [[nodiscard]] Result<void> setPose(std::size_t collider, std::optional<MeshPose> pose);
    /// The mesh of a collider that plays clips; null: that one does not.
    [[nodiscard]] const AnimatedMesh* animatedMesh(std::size_t collider) const;
    /// Before a step: uploads all of a world that is streamed that is wanted and has come, however many bytes, and requests the
    /// rest. Waits for that as its source does. Fails as WorldStream::finish does.
    [[nodiscard]] Result<void> load();
    /// nullopt: no world is streamed.
    [[nodiscard]] std::optional<StreamCounts> streamCounts() const {
        return stream_ ? std::optional(stream_->counts()) : std::nullopt;
    }
    /// The places of the colliders now: a pose each, in the scene's order. Of one that plays a clip it is that of mesh()'s origin.
    [[nodiscard]] std::vector<Pose> poses() const { return posesNow(particles_->time()); }
    /// The mesh of a collider that deforms, as it is now; null: that one does not.
    [[nodiscard]] const GpuMesh* mesh(std::size_t collider) const;

  private:
    struct LiveBody {
        std::size_t index;  // in the scene
        LiveCollider collider;
        WobblePass pass;
        MeshTrail trail = {};
    };
    /// A collider that plays a clip.
    struct PlayedBody {
        std::size_t index;  // in the scene
        AnimatedCollider collider;
        std::optional<MeshPose> pose = {};  // in place of the clip's
        /// The origin of the last pose: a run of a clip, or a program. From one to the next is a jump.
        struct Source {
            std::optional<std::size_t> clip;
            double run = 0.0;
            bool own = false;
            friend bool operator==(const Source&, const Source&) = default;
        };
        std::optional<Source> source = {};
        bool jumps = false;  // by the last pose
        MeshTrail trail = {};
    };
    Simulation() = default;
    [[nodiscard]] const PlayedBody* playedBody(std::size_t collider) const;
    /// Of a collider whose mesh bends; null: that of another one does not.
    [[nodiscard]] MeshTrail* trailOf(std::size_t collider);
    [[nodiscard]] Result<void> makeTextures(const LoadedScene& loaded,
                                            std::unique_ptr<ColliderSource> source);
    [[nodiscard]] WorldTextures& mutableTextures() { return stream_ ? stream_->textures() : *textures_; }
    /// Gives those that play a clip its pose at a time, in seconds; of an error none. Their bodies go with it: posesNow().
    [[nodiscard]] Result<void> playClips(double time);
    /// Moves the bodies; those that jump are there at once.
    void setPoses(double time);
    /// Of all bodies, at a time whose clips have been played.
    [[nodiscard]] std::vector<Pose> posesNow(double time) const;
    /// Of a world that is streamed, for a step from now on.
    [[nodiscard]] std::vector<PointOfInterest> streamPointsNow() const;
    [[nodiscard]] Result<void> stream();
    [[nodiscard]] Result<void> makeLive(const LoadedScene& loaded);
    /// Deforms all that are live to a time, in seconds, and draws their maps. Before each step, for its end.
    [[nodiscard]] Result<void> showLive(double time);
    /// The surfaces on which something will be born, where their colliders are now.
    void bendSurfaces(double dt);
    [[nodiscard]] Result<void> giveBirth(float dt);
    [[nodiscard]] Result<void> prewarm(Watchdog* watchdog, const std::function<void()>& checkpoint);
    /// \param tag  of its events; 0: not passed on.
    [[nodiscard]] Result<void> stepAs(std::uint64_t tag, float dt);
    [[nodiscard]] Result<void> moveColliders(double time);
    /// Has the events listed that the scene's [[spawn]] and the sink need, if any.
    [[nodiscard]] Result<void> setEvents();
    /// A list for each of the scene's [[spawn]], no longer than it can use; none where there are too many, or a sink needs more.
    [[nodiscard]] std::vector<EventOptions> spawnEventLists() const;
    void spawnFrom(const StepEvents& step);
    /// Until the events of at most so many steps are in flight.
    [[nodiscard]] Result<void> takeEvents(int in_flight);

    const LoadedScene* loaded_ = nullptr;
    const Scene* scene_ = nullptr;  // of those
    bool poses_change_ = false;
    std::vector<Pose> poses_;  // at the beginning
    std::vector<Pose> shown_;  // of the bodies on the GPU
    std::vector<Emitter> emitters_;
    std::vector<EmitterMotion> motions_;       // as many
    std::unique_ptr<WorldTextures> textures_;  // at one place: the particles point to it
    std::unique_ptr<WorldStream> stream_;      // in place of them
    bool stream_waits_ = true;
    std::optional<std::vector<PointOfInterest>> points_;
    std::vector<PointOfInterest> emitter_balls_;  // of a world that is streamed
    std::vector<LiveBody> live_;
    std::vector<PlayedBody> played_;
    std::unique_ptr<ParticleSystem> particles_;
    std::vector<Birth> births_;  // of a step, kept for its memory
    std::uint64_t refused_ = 0;
    std::uint64_t steps_ = 0;
    std::vector<ParticleType> types_;
    std::vector<std::string> warnings_;  // not taken yet
    SceneSweep sweep_;
    std::vector<SceneSpawn> spawns_;  // that the spawners are made of
    std::vector<Spawner> spawners_;
    std::vector<Birth> spawned_;  // for the next step
    std::vector<EventOptions> event_lists_;
    bool list_each_ = false;  // one for each spawner; else one for all
    EventSink event_sink_;    // may be empty
    float sink_min_speed_ = 0.0F;
    std::uint64_t sink_from_ = 1;          // the first step whose events it gets
    std::vector<StepEvents> held_events_;  // of a list that another one has replaced
};

}  // namespace relief
