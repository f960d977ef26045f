// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/simulation.h"
#include "runtime/air/particle_air.h"

#include <algorithm>
#include <limits>
#include <string>

#include "formats/base/file_io.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/pass_state.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/scene/scene_stream.h"
#include "runtime/scene/scene_touch.h"

namespace relief {
namespace {

// At the beginning of a step, only events of the previous step may be in flight. This is a fixed number, so that the
// births that events cause do not depend on timing.
constexpr int kStepsUnderWay = 1;

/// \param poses  one per collider.
std::vector<ColliderBody> bodiesOf(const LoadedScene& loaded, std::span<const Pose> poses) {
    std::vector<ColliderBody> bodies;
    for (std::size_t i = 0; i < loaded.colliders.size(); ++i) {
        const SceneCollider& from = loaded.scene.colliders[i];
        bodies.push_back(
            {loaded.colliders[i].get(), poses[i], from.restitution, from.friction, from.deforms()});
        if (from.tile_of) {
            bodies.back().group = std::min<std::size_t>(*from.tile_of, WorldTextures::kGroups - 1);
        }
    }
    return bodies;
}

Result<void> applyScene(const Scene& scene, ParticleSystem& particles) {
    RELIEF_TRY(particles.setForces({*scene.forces.gravity, scene.forces.wind,
                                    scene.air.viscosity ? 0.0F : scene.forces.drag,
                                    scene.air.viscosity.value_or(0.0F)}));
    RELIEF_TRY(particles.setTypes(particleTypes(scene)));
    RELIEF_TRY(setAir(particles, scene.air));
    return particles.setGround(scene.ground.enabled ? scene.ground.height : std::nullopt);
}

Result<ParticleSystem> makeParticles(const Scene& scene, const WorldTextures& textures, StepPath path,
                                     float sweep) {
    auto particles = RELIEF_TRY(ParticleSystem::create(
        {.capacity = scene.particles.capacity,
         .integrator = scene.time.integrator,
         .path = path,
         .start_time = -static_cast<double>(prewarmSteps(scene)) * static_cast<double>(scene.time.dt)}));
    RELIEF_TRY(particles.setCollider(&textures));
    RELIEF_TRY(applyScene(scene, particles));
    RELIEF_TRY(particles.setSweep(sweep));
    return particles;
}

std::vector<Pose> posesAt(const Scene& scene, double time) {
    std::vector<Pose> poses;
    for (const SceneCollider& collider : scene.colliders) {
        poses.push_back(poseAt(collider, time));
    }
    return poses;
}

/// Returns the body of a collider of the scene; null if `bodies` contains none.
template <class Bodies>
auto bodyOf(Bodies& bodies, std::size_t collider) {
    const auto found =
        std::find_if(bodies.begin(), bodies.end(), [&](const auto& body) { return body.index == collider; });
    return found == bodies.end() ? nullptr : &*found;
}

}  // namespace

/// Uploads the colliders: a single collider without a pose in its object space, all others in world space.
Result<void> Simulation::makeTextures(const LoadedScene& loaded, std::unique_ptr<ColliderSource> source) {
    const SceneCollider& first = loaded.scene.colliders.front();
    const std::vector<ColliderBody> bodies = bodiesOf(loaded, posesNow(0.0));
    if (loaded.scene.stream) {
        stream_ = RELIEF_TRY(makeStream(loaded, bodies, std::move(source)));
        return {};
    }
    const bool in_object_space = loaded.colliders.size() == 1 && !first.posed && !first.deforms();
    textures_ = std::make_unique<WorldTextures>(RELIEF_TRY(
        in_object_space ? WorldTextures::create(*loaded.colliders.front()) : WorldTextures::create(bodies)));
    return {};
}

std::vector<std::string> Simulation::takeWarnings() {
    std::vector<std::string> taken = std::exchange(warnings_, {});
    if (stream_) {
        for (std::string& line : stream_->takeWarnings()) {
            taken.push_back(std::move(line));
        }
    }
    return taken;
}

Result<Simulation> Simulation::create(const LoadedScene& loaded, SimulationOptions options) {
    Simulation made;
    Watchdog* const watchdog = options.watchdog;
    const Scene& scene = loaded.scene;
    made.loaded_ = &loaded;
    made.scene_ = &scene;
    made.emitters_ = loaded.emitters;
    made.emitter_balls_ = emitterBalls(made.emitters_);
    made.types_ = particleTypes(scene);
    made.warnings_ = loaded.warnings;
    made.sweep_ = loaded.sweep;
    const float sweep = made.sweep_.lengthFor(scene.time.dt, scene, made.warnings_);
    made.motions_ = emitterMotions(loaded);
    made.poses_change_ = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                                     [](const SceneCollider& c) { return !c.keys.empty() || c.play; });
    made.poses_ = posesAt(scene, 0.0);
    if (options.source) {
        made.stream_waits_ = false;
        made.points_.emplace();
    }
    RELIEF_TRY(watched(watchdog, "the shaders of colliders", [&] { return made.makeLive(loaded); }));
    RELIEF_TRY(withPrefix(quotedPath(scene.world.empty() ? scene.colliders.front().path : scene.world),
                          watched(watchdog, "uploading the collider",
                                  [&] { return made.makeTextures(loaded, std::move(options.source)); })));
    auto particles = RELIEF_TRY(watched(watchdog, "the shaders of particles", [&] {
        return makeParticles(scene, made.textures(), options.path, sweep);
    }));
    made.particles_ = std::make_unique<ParticleSystem>(std::move(particles));
    RELIEF_TRY(watched(watchdog, "the colliders' first maps",
                       [&] { return made.showLive(made.particles_->time()); }));
    RELIEF_TRY(watched(watchdog, "the shaders of events", [&] { return made.setEvents(); }));
    RELIEF_TRY(made.prewarm(watchdog, options.checkpoint));
    return made;
}

Result<void> Simulation::prewarm(Watchdog* watchdog, const std::function<void()>& checkpoint) {
    // Few steps per wait, so that the watchdog does not expire.
    constexpr std::uint32_t kAtOnce = 4;
    static constexpr const char* kWhat = "warming up";
    const std::uint32_t steps = prewarmSteps(*scene_);
    for (std::uint32_t step = 0; step < steps; ++step) {
        RELIEF_TRY(stepAs(0, scene_->time.dt));
        if ((step + 1) % kAtOnce == 0 || step + 1 == steps) {
            RELIEF_TRY(watched(watchdog, kWhat, [] { return waitForGpu(kWhat); }));
            if (checkpoint) {
                checkpoint();
            }
        }
    }
    return steps > 0 ? checkAllocated(kWhat, "choose a smaller capacity") : Result<void>{};
}

Result<void> Simulation::stepAs(std::uint64_t tag, float dt) {
    RELIEF_TRY(takeEvents(kStepsUnderWay));
    RELIEF_TRY(emitBirths(dt));
    const PassState state(PassState::Scope::kSequence);
    const double end = particles_->time() + static_cast<double>(dt);
    RELIEF_TRY(playClips(end));
    if (poses_change_) {
        setPoses(end);
    }
    RELIEF_TRY(showLive(end));
    RELIEF_TRY(stream_ && !stream_waits_ ? stream_->update(streamPointsNow()) : load());
    RELIEF_TRY(particles_->setSweep(sweep_.lengthFor(dt, *scene_, warnings_)));
    RELIEF_TRY(particles_->step(dt));
    if (eventList(*particles_) != nullptr) {
        requestEvents(*particles_, tag);
    }
    return {};
}

Result<std::size_t> Simulation::spawn(std::span<const Birth> births) {
    const std::size_t accepted = RELIEF_TRY(particles_->spawn(births));
    sweep_.add(*scene_, births);
    return accepted;
}

Result<void> Simulation::listHits(float min_speed, EventSink sink) {
    event_sink_ = std::move(sink);
    sink_min_speed_ = min_speed;
    sink_from_ = steps_ + 1;
    return setEvents();
}

std::vector<EventOptions> Simulation::spawnEventLists() const {
    std::vector<EventOptions> lists;
    if (event_sink_ || spawners_.size() > kEventLists) {
        return lists;
    }
    for (const Spawner& spawner : spawners_) {
        lists.push_back(spawner.eventOptions());
        lists.back().max_per_step = std::min(lists.back().max_per_step, kEventsMax);
    }
    return lists;
}

Result<void> Simulation::setEvents() {
    if (spawns_ != scene_->spawns) {
        spawns_ = scene_->spawns;
        spawners_ = makeSpawners(spawns_, textures().materialNames());
    }
    constexpr float kNone = std::numeric_limits<float>::infinity();
    EventOptions options{
        .hits = false, .min_speed = event_sink_ ? sink_min_speed_ : kNone, .max_per_step = kEventsMax};
    for (const SceneSpawn& spawn : spawns_) {
        const bool death = spawn.on == SpawnOn::kDeath;
        options.deaths = options.deaths || death;
        options.min_speed = std::min(options.min_speed, death ? kNone : spawn.min_speed);
    }
    options.hits = options.min_speed < kNone;
    options.min_speed = options.hits ? options.min_speed : 0.0F;
    std::vector<EventOptions> lists = spawnEventLists();
    list_each_ = !lists.empty();
    if (!list_each_ && (options.hits || options.deaths)) {
        lists.push_back(options);
    }
    if (lists == event_lists_) {
        return {};
    }
    while (auto events = RELIEF_TRY(waitEvents(*particles_))) {
        held_events_.push_back(std::move(*events));
    }
    RELIEF_TRY(relief::setEvents(*particles_, lists));
    event_lists_ = std::move(lists);
    return {};
}

Result<void> Simulation::takeEvents(int in_flight) {
    while (static_cast<int>(held_events_.size()) + eventsInFlight(*particles_) > in_flight) {
        std::optional<StepEvents> events;
        if (held_events_.empty()) {
            events = RELIEF_TRY(waitEvents(*particles_));
        } else {
            events = std::move(held_events_.front());
            held_events_.erase(held_events_.begin());
        }
        if (!events) {
            return {};
        }
        if (event_sink_ && events->tag >= sink_from_) {
            RELIEF_TRY(event_sink_(*events));
        }
        spawnFrom(*events);
    }
    return {};
}

void Simulation::spawnFrom(const StepEvents& step) {
    // If the step has several lists, they are one per spawner, even if the lists have been replaced since.
    const bool several = step.lists.size() > 1;
    const bool each = several || list_each_;
    rejected_ += each || spawners_.empty() ? 0 : step.dropped;
    for (std::size_t i = 0; i < spawners_.size(); ++i) {
        const bool own = i < step.lists.size();
        const std::uint64_t room =
            particles_->room() - std::min<std::uint64_t>(particles_->room(), spawned_.size());
        const std::uint64_t least = spawners_[i].settings().count_min;
        rejected_ += each && own ? least * step.lists[i].dropped : 0;
        if (own || !several) {
            rejected_ += spawners_[i].spawn(several ? step.of(i) : step.events, types_, room, spawned_);
        }
    }
}

Result<void> Simulation::change(std::optional<std::vector<Emitter>> emitters) {
    if (emitters) {
        emitters_ = std::move(*emitters);
        emitter_balls_ = emitterBalls(emitters_);
        sweep_.add(*scene_, emitters_);
    } else {
        sweep_.change(*scene_);
    }
    motions_ = emitterMotions(*loaded_);
    types_ = particleTypes(*scene_);
    poses_change_ = poses_change_ || posesAt(*scene_, particles_->time()) != poses_;
    RELIEF_TRY(applyScene(*scene_, *particles_));
    return setEvents();
}

void Simulation::updateSurfaces(double dt) {
    for (std::size_t i = 0; i < emitters_.size(); ++i) {
        const SceneEmitter& from = scene_->emitters[i];
        MeshTrail* const trail =
            from.followsShape() && emitters_[i].isDue(dt) ? trailOf(*from.attach) : nullptr;
        if (trail == nullptr) {
            continue;  // not due, or rigid in its collider's space
        }
        trail->bend(emitters_[i]);
        if (stream_) {
            emitter_balls_[i] = emitterBalls(std::span(emitters_).subspan(i, 1)).front();
        }
    }
}

Result<void> Simulation::emitBirths(float dt) {
    updateSurfaces(static_cast<double>(dt));
    births_.clear();
    births_.swap(spawned_);
    sweep_.add(*scene_, births_);
    const std::uint64_t room =
        particles_->room() - std::min<std::uint64_t>(particles_->room(), births_.size());
    rejected_ += emitAll(emitters_, static_cast<double>(dt), room, births_, motions_, particles_->time());
    [[maybe_unused]] const std::size_t accepted = RELIEF_TRY(particles_->spawn(births_));
    return {};
}

std::vector<PointOfInterest> Simulation::streamPointsNow() const {
    const double time = particles_->time();
    std::vector<PointOfInterest> points =
        emitterPoints(emitter_balls_, motions_, scene_->stream->radius, time);
    if (points_) {
        points.insert(points.end(), points_->begin(), points_->end());
    } else {
        points.push_back({sceneCamera(*scene_, loaded_->bounds, time).eye, scene_->stream->radius});
    }
    return points;
}

Result<void> Simulation::makeLive(const LoadedScene& loaded) {
    for (std::size_t i = 0; i < loaded.live.size(); ++i) {
        if (!loaded.live[i]) {
            continue;
        }
        const LiveMesh& live = *loaded.live[i];
        const std::string& origin = loaded.scene.colliders[i].origin;
        auto collider = RELIEF_TRY(
            withPrefix(origin + ": collider.mesh",
                       LiveCollider::create(live.mesh.positions, trianglesOf(live.mesh), live.frames)));
        auto pass =
            RELIEF_TRY(withPrefix(origin + ": collider.deform",
                                  WobblePass::create(live.wobble, live.mesh.positions, live.mesh.normals)));
        live_.push_back({i, std::move(collider), std::move(pass)});
    }
    for (std::size_t i = 0; i < loaded.played.size(); ++i) {
        if (const auto& played = loaded.played[i]) {
            auto collider = RELIEF_TRY(withPrefix(
                loaded.scene.colliders[i].origin + ": collider.play",
                AnimatedCollider::create(
                    played->mesh, {.resolution = played->play.resolution, .box_size = played->box_size})));
            played_.push_back({i, std::move(collider)});
        }
    }
    return playClips(0.0);
}

Result<void> Simulation::playClips(double time) {
    std::vector<MeshPose> poses;
    for (const PlayedBody& body : played_) {
        poses.push_back(body.pose ? *body.pose : loaded_->played[body.index]->poseAt(time));
        RELIEF_TRY(withPrefix(scene_->colliders[body.index].origin + ": collider.play",
                              body.collider.check(poses.back())));
    }
    for (std::size_t i = 0; i < played_.size(); ++i) {
        PlayedBody& body = played_[i];
        const PlayedMesh& played = *loaded_->played[body.index];
        const bool own = body.pose.has_value();
        const PlayedBody::Source source{own ? std::nullopt : played.clip,
                                        own || played.cyclic ? 0.0 : played.run(time), own};
        RELIEF_TRY(body.collider.setPose(poses[i]));
        body.jumps = body.source != source;
        const auto show = [&](double at, MeshPose pose, bool jumps) {
            body.trail.show(
                at, [mesh = played.mesh, pose = std::move(pose)] { return posed(*mesh, pose); }, jumps);
        };
        const double before = time - static_cast<double>(scene_->time.dt);
        if (!body.source && !own && (played.cyclic || played.run(before) == played.run(time))) {
            show(before, played.poseAt(before), true);  // the clip was already moving before the first step
            show(time, std::move(poses[i]), false);
        } else {
            show(time, std::move(poses[i]), body.jumps);
        }
        body.source = source;
        if (body.jumps) {
            body.collider.settle();
        }
    }
    return {};
}

void Simulation::setPoses(double time) {
    const auto upload = [&](const std::vector<Pose>& poses) {
        stream_ ? stream_->setPoses(poses) : textures_->setPoses(poses);
    };
    std::vector<Pose> poses = posesNow(time);
    const bool jumps =
        std::any_of(played_.begin(), played_.end(), [](const PlayedBody& body) { return body.jumps; });
    if (jumps && !shown_.empty()) {
        // Jumping bodies start the step at its final pose.
        for (const PlayedBody& body : played_) {
            shown_[body.index] = body.jumps ? poses[body.index] : shown_[body.index];
        }
        upload(shown_);
    }
    upload(poses);
    shown_ = std::move(poses);
}

std::vector<Pose> Simulation::posesNow(double time) const {
    std::vector<Pose> poses = posesAt(*scene_, time);
    for (const PlayedBody& body : played_) {
        poses[body.index] = body.collider.placed(poses[body.index]);
    }
    return poses;
}

Result<void> Simulation::showLive(double time) {
    for (LiveBody& body : live_) {
        const LiveMesh* const live = &*loaded_->live[body.index];
        const auto show = [&](double at, bool jumps) {
            body.trail.show(
                at,
                [live, at] { return wobbled(live->wobble, live->mesh.positions, live->mesh.normals, at); },
                jumps);
        };
        if (body.trail.empty()) {
            show(time - static_cast<double>(scene_->time.dt), true);
        }
        show(time, false);
        body.pass.run(time);
        RELIEF_TRY(body.collider.setPositions(body.pass.buffer().name()));
        RELIEF_TRY(body.collider.update(mutableTextures(), body.index));
    }
    for (PlayedBody& body : played_) {
        RELIEF_TRY(body.collider.update(mutableTextures(), body.index));
    }
    return {};
}

const GpuMesh* Simulation::mesh(std::size_t collider) const {
    if (const LiveBody* live = bodyOf(live_, collider)) {
        return &live->collider.mesh();
    }
    const PlayedBody* played = bodyOf(played_, collider);
    return played == nullptr ? nullptr : &played->collider.live().mesh();
}

MeshTrail* Simulation::trailOf(std::size_t collider) {
    if (LiveBody* live = bodyOf(live_, collider)) {
        return &live->trail;
    }
    PlayedBody* played = bodyOf(played_, collider);
    return played == nullptr ? nullptr : &played->trail;
}

const AnimatedMesh* Simulation::animatedMesh(std::size_t collider) const {
    const PlayedBody* played = bodyOf(played_, collider);
    return played == nullptr ? nullptr : &played->collider.mesh();
}

Result<void> Simulation::setPose(std::size_t collider, std::optional<MeshPose> pose) {
    PlayedBody* played = bodyOf(played_, collider);
    if (played == nullptr) {
        return fail(ErrorCode::kUsage,
                    "collider " + std::to_string(collider) + " plays no clip; add 'play' in the scene");
    }
    RELIEF_TRY(pose ? played->collider.check(*pose) : Result<void>());
    played->pose = std::move(pose);
    return {};
}

}  // namespace relief
