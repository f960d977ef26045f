// SPDX-License-Identifier: Apache-2.0
// The emitters, particles and colliders of a scene on the GPU, stepped together.
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
    StepPath path = StepPath::kAuto;  ///< of particle steps
    Watchdog* watchdog = nullptr;     ///< may be null
    /// Called between steps before time 0; its exceptions propagate from create(). May be empty.
    std::function<void()> checkpoint = {};
    /// Loads the colliders of a scene with a [stream]. Steps do not wait for the source, so runs may differ. The
    /// scene's camera is then not a point of interest. Null: reads the files of the world; each step waits for its
    /// colliders.
    std::unique_ptr<ColliderSource> source = nullptr;
};

class Simulation {
  public:
    /// Needs a current context, as step() does. Runs the steps before time 0 (time.prewarm).
    /// \param loaded  must outlive this.
    /// Errors: those of WorldTextures, LiveCollider, WobblePass, AnimatedCollider and ParticleSystem. Errors of
    /// textures name the world of the scene, or its first collider.
    [[nodiscard]] static Result<Simulation> create(const LoadedScene& loaded, SimulationOptions options = {});

    /// ParticleSystem::startStep()
    [[nodiscard]] Result<void> startStep() { return particles_->startStep(); }

    /// Emits births, including births of [[spawn]] from events of the step before the last; updates poses and shapes of
    /// colliders to the end of the step; then steps the particles.
    /// Errors: those of LiveCollider::update and ParticleSystem::step.
    [[nodiscard]] Result<void> step() { return step(scene_->time.dt); }
    /// \param dt  seconds, > 0, instead of time.dt.
    [[nodiscard]] Result<void> step(float dt) { return stepAs(++steps_, dt); }

    /// Applies changed forces, collision, types, air, ground, spawns and poses of the scene passed to create(), and
    /// keeps all particles. Capacity, integrator and colliders must be unchanged, except poses. A collider moves from
    /// its old pose to the new one during the next step; the pose of a single collider in object space has no effect.
    /// \param emitters  replace the current ones; nullopt: keep them.
    /// Errors: those of the setters of ParticleSystem, setAir(), waitEvents() and relief::setEvents().
    [[nodiscard]] Result<void> change(std::optional<std::vector<Emitter>> emitters);

    /// Passes the events of each step to `sink`, in order, starting with the next step. Events of step n are passed
    /// when step n + 2 begins, so that the CPU rarely waits for the GPU. StepEvents::tag is the number of the step,
    /// from 1. The events are new hits and the events that [[spawn]] needs, together at most kEventsMax per step.
    /// \param min_speed  slower hits may be omitted.
    /// Errors: those of setEvents().
    using EventSink = std::function<Result<void>(const StepEvents&)>;
    [[nodiscard]] Result<void> listHits(float min_speed, EventSink sink);
    static constexpr std::uint32_t kEventsMax = 1U << 18;
    /// Passes the events that are still in flight to the sink. Errors: those of the sink and of waitEvents().
    [[nodiscard]] Result<void> finishEvents() { return takeEvents(0); }

    /// Queues births for the next step, in addition to those of the emitters. Result and errors: as
    /// ParticleSystem::spawn().
    [[nodiscard]] Result<std::size_t> spawn(std::span<const Birth> births);

    [[nodiscard]] const ParticleSystem& particles() const { return *particles_; }
    [[nodiscard]] const WorldTextures& textures() const { return stream_ ? stream_->textures() : *textures_; }
    /// Returns the warnings since the last call: those of the scene (LoadedScene::warnings), and one line for each
    /// collider of a streamed world that failed to load.
    [[nodiscard]] std::vector<std::string> takeWarnings();
    /// Returns the number of due births of emitters and [[spawn]] that were rejected, for example because of the
    /// capacity, a full event list or SpawnSettings::max_per_step.
    [[nodiscard]] std::uint64_t rejected() const { return rejected_; }
    /// Sets the points around which a streamed world has full detail, in addition to the emitters and instead of the
    /// scene's camera. Takes effect with the next step.
    void setPoints(std::vector<PointOfInterest> points) { points_ = std::move(points); }
    /// Sets the pose of a collider that plays a clip, from the next step on; nullopt: the clip continues.
    /// Errors: kUsage (the collider plays no clip; AnimatedCollider::check()).
    [[nodiscard]] Result<void> setPose(std::size_t collider, std::optional<MeshPose> pose);
    /// Returns the mesh of a collider that plays clips; null for other colliders.
    [[nodiscard]] const AnimatedMesh* animatedMesh(std::size_t collider) const;
    /// Uploads the colliders of a streamed world that the points of interest need, without a byte limit. Waits for
    /// colliders that are not loaded yet, if the source can wait. Call it before a step.
    /// Errors: those of WorldStream::finish().
    [[nodiscard]] Result<void> load() {
        return stream_ ? stream_->finish(streamPointsNow()) : Result<void>();
    }
    /// Returns nullopt if no world is streamed.
    [[nodiscard]] std::optional<StreamCounts> streamCounts() const {
        return stream_ ? std::optional(stream_->counts()) : std::nullopt;
    }
    /// Returns the current poses of the colliders, in the order of the scene. The pose of an animated collider places
    /// mesh(), whose origin is the centre of the collider's box (AnimatedCollider::middle()).
    [[nodiscard]] std::vector<Pose> poses() const { return posesNow(particles_->time()); }
    /// Returns the current mesh of a deforming collider; null for other colliders.
    [[nodiscard]] const GpuMesh* mesh(std::size_t collider) const;

  private:
    struct LiveBody {
        std::size_t index;  // collider of the scene
        LiveCollider collider;
        WobblePass pass;
        MeshTrail trail = {};
    };
    /// A collider that plays a clip.
    struct PlayedBody {
        std::size_t index;  // collider of the scene
        AnimatedCollider collider;
        std::optional<MeshPose> pose = {};  // overrides the clip
        /// The source of the last pose: one run of a clip, or setPose(). A change of source is a jump.
        struct Source {
            std::optional<std::size_t> clip;
            double run = 0.0;
            bool own = false;
            friend bool operator==(const Source&, const Source&) = default;
        };
        std::optional<Source> source = {};
        bool jumps = false;  // at the last pose
        MeshTrail trail = {};
    };
    Simulation() = default;
    /// Returns the trail of a deforming collider; null for other colliders.
    [[nodiscard]] MeshTrail* trailOf(std::size_t collider);
    [[nodiscard]] Result<void> makeTextures(const LoadedScene& loaded,
                                            std::unique_ptr<ColliderSource> source);
    [[nodiscard]] WorldTextures& mutableTextures() { return stream_ ? stream_->textures() : *textures_; }
    /// Moves all clips to a time, in seconds; on error, moves none. Later calls of posesNow() must pass the same time.
    [[nodiscard]] Result<void> playClips(double time);
    /// Moves the bodies. A body that jumps does not push particles.
    void setPoses(double time);
    /// Returns the poses of all bodies. \param time  the time of the last playClips().
    [[nodiscard]] std::vector<Pose> posesNow(double time) const;
    /// Returns the points of interest of a streamed world for the next step.
    [[nodiscard]] std::vector<PointOfInterest> streamPointsNow() const;
    [[nodiscard]] Result<void> makeLive(const LoadedScene& loaded);
    /// Deforms all live colliders to their shapes at a time, in seconds, and draws their maps. Called before each step,
    /// with the time of its end.
    [[nodiscard]] Result<void> showLive(double time);
    /// Updates the emitting surfaces to the current shapes of their colliders.
    void updateSurfaces(double dt);
    [[nodiscard]] Result<void> emitBirths(float dt);
    [[nodiscard]] Result<void> prewarm(Watchdog* watchdog, const std::function<void()>& checkpoint);
    /// \param tag  of the events; 0: do not pass them on.
    [[nodiscard]] Result<void> stepAs(std::uint64_t tag, float dt);
    /// Records the events that [[spawn]] and the sink need, if any.
    [[nodiscard]] Result<void> setEvents();
    /// Returns one list for each [[spawn]], limited to the number of events that the [[spawn]] can use. Returns an
    /// empty vector if there are more than kEventLists [[spawn]], or if there is a sink.
    [[nodiscard]] std::vector<EventOptions> spawnEventLists() const;
    void spawnFrom(const StepEvents& step);
    /// Processes events until the events of at most `in_flight` steps are pending.
    [[nodiscard]] Result<void> takeEvents(int in_flight);

    const LoadedScene* loaded_ = nullptr;
    const Scene* scene_ = nullptr;  // loaded_->scene
    bool poses_change_ = false;
    std::vector<Pose> poses_;  // initial poses
    std::vector<Pose> shown_;  // poses on the GPU
    std::vector<Emitter> emitters_;
    std::vector<EmitterMotion> motions_;       // one per emitter
    std::unique_ptr<WorldTextures> textures_;  // stable address: the particles point to it
    std::unique_ptr<WorldStream> stream_;      // used instead of textures_ if streamed
    bool stream_waits_ = true;
    std::optional<std::vector<PointOfInterest>> points_;
    std::vector<PointOfInterest> emitter_balls_;  // emitterBalls(), for a streamed world
    std::vector<LiveBody> live_;
    std::vector<PlayedBody> played_;
    std::unique_ptr<ParticleSystem> particles_;
    std::vector<Birth> births_;  // reused buffer of a step
    std::uint64_t rejected_ = 0;
    std::uint64_t steps_ = 0;
    std::vector<ParticleType> types_;
    std::vector<std::string> warnings_;  // not returned yet
    SceneSweep sweep_;
    std::vector<SceneSpawn> spawns_;  // settings of spawners_
    std::vector<Spawner> spawners_;
    std::vector<Birth> spawned_;  // for the next step
    std::vector<EventOptions> event_lists_;
    bool list_each_ = false;  // one list per spawner instead of one for all
    EventSink event_sink_;    // may be empty
    float sink_min_speed_ = 0.0F;
    std::uint64_t sink_from_ = 1;          // first step whose events go to the sink
    std::vector<StepEvents> held_events_;  // recorded with previous event lists
};

}  // namespace relief
