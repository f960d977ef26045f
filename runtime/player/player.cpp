#include "runtime/player/player.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <limits>
#include <memory>
#include <span>
#include <system_error>
#include <vector>

#include "formats/base/file_io.h"
#include "runtime/files/ply.h"
#include "runtime/files/png.h"
#include "runtime/files/video.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/frame.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/player/live_bodies.h"
#include "runtime/player/statistics_log.h"
#include "runtime/scene/scene_pictures.h"
#include "runtime/tool/gpu_tool.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Steps between two calls of PlayerOptions::progress, and between two waits for the GPU: without them a
// driver would be handed a whole run at once.
constexpr std::uint32_t kStepsAtOnce = 16;
// A stretch of steps that takes longer is halved: progress moves, and no watchdog takes it for a hang.
constexpr std::chrono::seconds kStretchMax{4};

/// Tells the watchdog, if there is one, what the GPU is about to do; and the other way round.
void feed(const PlayerOptions& options, const std::string& what) {
    if (options.watchdog != nullptr) {
        options.watchdog->feed(what);
    }
}
void rest(const PlayerOptions& options) {
    if (options.watchdog != nullptr) {
        options.watchdog->rest();
    }
}

/// Makes the folder, and sees early that it can be written: a run may take long.
Result<void> prepareFolder(const fs::path& folder, const char* option) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder, error)) {
        return fail(ErrorCode::kIo, "cannot make the folder " + quotedPath(folder) + " for frames: " +
                                        (error ? error.message() : "a file of that name is in the way") +
                                        "; choose another with " + option);
    }
    return {};
}

Result<void> checkDumpFolder(const fs::path& dump) {
    std::error_code error;
    const fs::path folder = dump.has_parent_path() ? dump.parent_path() : fs::path(".");
    if (dump != "-" && !fs::is_directory(folder, error)) {
        return fail(ErrorCode::kIo, "cannot write " + quotedPath(dump) + ": there is no folder " +
                                        quotedPath(folder) +
                                        "; make it, or choose another place with --dump");
    }
    if (fs::is_directory(dump, error)) {
        return fail(ErrorCode::kIo,
                    "cannot write " + quotedPath(dump) + ": it is a folder; name a file with --dump");
    }
    return {};
}

/// Everything that draws, made only where frames are wanted.
class Picture {
  public:
    static Result<Picture> create(const Scene& scene, const LoadedScene& loaded,
                                  const ColliderTextures& textures) {
        float texel = std::numeric_limits<float>::max();
        for (std::size_t i = 0; i < loaded.colliders.size(); ++i) {
            texel = std::min(texel, scene.colliders[i].pose.scale * finestTexel(loaded.colliders[i]));
        }
        const ColliderView view{&textures, loaded.bounds, texel};
        auto frame = RELIEF_TRY(Frame::create(scene.render.width, scene.render.height));
        auto atlas = RELIEF_TRY(loadAtlas(scene));
        std::optional<LivePicture> live;
        if (!scene.render.mesh.empty() && loaded.live.front()) {
            auto made = RELIEF_TRY(LivePicture::create(*loaded.live.front()));
            live.emplace(std::move(made));
        }
        auto mesh = RELIEF_TRY(live ? Result<std::unique_ptr<ColliderMesh>>{}
                                    : loadColliderMesh(scene, loaded.bounds));
        auto collider_renderer =
            RELIEF_TRY(ColliderRenderer::create(view, live ? &live->mesh() : mesh.get()));
        auto particle_renderer = RELIEF_TRY(ParticleRenderer::create(view));
        Picture picture{std::move(frame), std::move(collider_renderer), std::move(particle_renderer)};
        picture.scene_ = &scene;
        if (scene.render.sort_frames > 0) {
            auto sorter = RELIEF_TRY(DepthSorter::create(scene.capacity));
            picture.sorter_.emplace(std::move(sorter));
        }
        picture.bounds_ = loaded.bounds;
        if (scene.ground.enabled) {
            picture.collider_style_.ground = scene.ground.height;
        }
        picture.collider_style_.background = scene.render.background;
        picture.particle_style_ = particleStyle(scene, atlas.get());
        picture.atlas_ = std::move(atlas);
        picture.mesh_ = std::move(mesh);
        picture.live_ = std::move(live);
        return picture;
    }

    /// 3 · width · height bytes sRGB, the top row first.
    Result<std::vector<std::uint8_t>> draw(const ParticleSystem& particles, StageTimer* stages) {
        const Camera camera = sceneCamera(*scene_, bounds_, particles.time());
        ParticleOrder order;
        if (sorter_) {
            const StageScope scope(stages, Stage::kSort);
            sorter_->update(particles.positions(), particles.textureWidth(), particles.extent(), camera.eye,
                            DepthSorter::passesPerFrame(particles.extent(), scene_->render.sort_frames));
            order = {&sorter_->order(), sorter_->count()};
        }
        const StageScope scope(stages, Stage::kDraw);
        if (live_) {
            live_->show(particles.time());
        }
        RELIEF_TRY(collider_.draw(camera, collider_style_, frame_.target()));
        RELIEF_TRY(
            particles_.draw(particles, camera, particle_style_, frame_.target(), order, &collider_.depth()));
        std::vector<std::uint8_t> rgb = frame_.read();
        RELIEF_TRY(checkGpu("drawing a picture"));
        return rgb;
    }

  private:
    Picture(Frame frame, ColliderRenderer collider, ParticleRenderer particles)
        : frame_(std::move(frame)), collider_(std::move(collider)), particles_(std::move(particles)) {}

    const Scene* scene_ = nullptr;  // outlives the picture
    Bounds bounds_;
    std::unique_ptr<SpriteAtlas> atlas_;
    std::unique_ptr<ColliderMesh> mesh_;
    std::optional<LivePicture> live_;  // instead
    Frame frame_;
    ColliderRenderer collider_;
    ParticleRenderer particles_;
    ColliderStyle collider_style_;
    ParticleStyle particle_style_;
    std::optional<DepthSorter> sorter_;
};

/// "frame_", 7, ".png" -> folder/frame_0007.png
fs::path numberedPath(const fs::path& folder, const char* head, std::uint32_t number, const char* ending) {
    std::array<char, 48> name{};
    std::snprintf(name.data(), name.size(), "%s%04u%s", head, number, ending);
    return folder / name.data();
}

/// What is made while the run goes on; each only where it is wanted.
struct Outputs {
    std::optional<Picture> picture;
    std::unique_ptr<VideoWriter> video;
    std::optional<GpuTimer> timer;
    std::optional<StatisticsLog> log;

    [[nodiscard]] StageTimer* stages() { return timer ? &*timer : nullptr; }
};

/// The rate at which a video plays in the scene's time, as far as eyes and players go along.
double videoRate(const Scene& scene) {
    return std::clamp(1.0 / (static_cast<double>(scene.dt) * scene.render.every), 1.0, 120.0);
}

Result<void> openOutputs(const PlayerOptions& options, const Scene& scene, const LoadedScene& loaded,
                         const ColliderTextures& textures, Outputs& outputs) {
    if (!options.frames.empty() || !options.video.empty()) {
        feed(options, "the shaders of pictures");
        auto made = Picture::create(scene, loaded, textures);
        rest(options);
        if (!made) {
            return forward(made);
        }
        outputs.picture.emplace(std::move(*made));
    }
    if (!options.video.empty()) {
        auto video = RELIEF_TRY(
            VideoWriter::create(options.video, {scene.render.width, scene.render.height, videoRate(scene)}));
        outputs.video = std::move(video);
        if (options.watchdog != nullptr) {
            options.watchdog->setCleanUp([writer = outputs.video.get()] { writer->abandon(); });
        }
    }
    if (options.time_stages || !options.stats.empty()) {
        outputs.timer.emplace();
    }
    if (!options.stats.empty()) {
        auto log = RELIEF_TRY(StatisticsLog::create(options.stats, scene.capacity, *outputs.timer));
        outputs.log.emplace(std::move(log));
    }
    for (const auto& [folder, option] :
         {std::pair(options.frames, "--frames"), {options.dump_frames, "--dump-frames"}}) {
        if (folder.empty()) {
            continue;
        }
        RELIEF_TRY(prepareFolder(folder, option));
    }
    return {};
}

/// A frame of every kind that is wanted, all of the same step.
Result<void> writeFrame(const PlayerOptions& options, const ParticleSystem& particles, Outputs& outputs,
                        PlayerReport& report) {
    if (outputs.picture) {
        feed(options, "picture " + std::to_string(report.frames_written));
        const auto rgb = outputs.picture->draw(particles, outputs.stages());
        rest(options);
        if (!rgb) {
            return forward(rgb);
        }
        if (!options.frames.empty()) {
            const auto png =
                RELIEF_TRY(encodePng(*rgb, report.scene.render.width, report.scene.render.height));
            const fs::path path = numberedPath(options.frames, "frame_", report.frames_written, ".png");
            RELIEF_TRY(writeFile(path, png));
        }
        if (outputs.video) {
            RELIEF_TRY(outputs.video->add(*rgb));
        }
        ++report.frames_written;
    }
    if (!options.dump_frames.empty()) {
        feed(options, "reading particles back");
        const auto state = particles.readState();
        rest(options);
        if (!state) {
            return forward(state);
        }
        const fs::path path = numberedPath(options.dump_frames, "particles_", report.dumps_written, ".ply");
        RELIEF_TRY(writeFile(path, encodePly(*state)));
        ++report.dumps_written;
    }
    return {};
}

Result<ParticleSystem> makeParticles(const Scene& scene, const ColliderTextures& textures) {
    auto particles = ParticleSystem::create({.capacity = scene.capacity, .integrator = scene.integrator});
    if (!particles) {
        return particles;
    }
    const std::array<ColliderInstance, 1> colliders{ColliderInstance{&textures}};
    RELIEF_TRY(particles->setColliders(colliders));
    particles->setForces({*scene.forces.gravity, scene.forces.wind,
                          scene.air.viscosity ? 0.0F : scene.forces.drag,
                          scene.air.viscosity.value_or(0.0F)});
    particles->setCollision(scene.collision);
    if (!scene.types.empty()) {
        RELIEF_TRY(particles->setTypes(scene.types));
    }
    if (scene.sweep > 0.0F) {
        RELIEF_TRY(particles->setSweep(scene.sweep));
    }
    RELIEF_TRY(particles->setAir(scene.air));
    particles->setGround(scene.ground.enabled ? scene.ground.height : std::nullopt);
    return particles;
}

/// The lower of the two middle ones where their number is even; 0 of none.
double median(std::vector<double> values) {
    if (values.empty()) {
        return 0.0;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::vector<Pose> posesAt(const Scene& scene, double time) {
    std::vector<Pose> poses;
    for (const SceneCollider& collider : scene.colliders) {
        poses.push_back(poseAt(collider, time));
    }
    return poses;
}

/// The colliders on the GPU: a single one without a pose in its own space, others in the world.
Result<ColliderTextures> makeTextures(const Scene& scene, std::span<const Collider> colliders) {
    if (colliders.size() == 1 && !scene.colliders.front().posed && !scene.colliders.front().live) {
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

/// What the watchdog would clean up does not outlive the run.
class WithoutCleanUp {
  public:
    explicit WithoutCleanUp(Watchdog* watchdog) : watchdog_(watchdog) {}
    WithoutCleanUp(const WithoutCleanUp&) = delete;
    WithoutCleanUp& operator=(const WithoutCleanUp&) = delete;
    ~WithoutCleanUp() {
        if (watchdog_ != nullptr) {
            watchdog_->rest();
            watchdog_->setCleanUp({});
        }
    }

  private:
    Watchdog* watchdog_;
};

/// The run itself: steps and, between them, frames.
Result<void> run(const PlayerOptions& options, std::span<Emitter> emitters, ColliderTextures& textures,
                 LiveBodies& live, ParticleSystem& particles, Outputs& outputs, PlayerReport& report) {
    const Scene& scene = report.scene;
    const bool has_frames = outputs.picture || !options.dump_frames.empty();
    const std::uint32_t stats_every = options.stats_every.value_or(scene.render.every);
    const bool moves = std::any_of(scene.colliders.begin(), scene.colliders.end(),
                                   [](const SceneCollider& c) { return !c.keys.empty(); });
    std::vector<Birth> births;
    std::uint64_t refused = 0;
    Clock::duration spent{};
    std::vector<double> stretches;  // ms per step of each
    std::uint32_t step = 0;
    std::uint32_t at_once = kStepsAtOnce;
    while (step < scene.steps || (step == 0 && has_frames)) {
        const std::uint32_t next_frame =
            has_frames ? step + scene.render.every - step % scene.render.every : scene.steps;
        const std::uint32_t end = std::min({scene.steps, next_frame, step + at_once});
        const Clock::time_point begun = Clock::now();
        const std::uint32_t first = step;
        const std::string steps = "steps " + std::to_string(first + 1) + " to " + std::to_string(end);
        feed(options, steps);
        while (step < end) {
            {
                const StageScope scope(outputs.stages(), Stage::kBirths);
                births.clear();
                refused += emitAll(emitters, static_cast<double>(scene.dt), particles.room(), births);
                particles.spawn(births);
            }
            {
                const StageScope scope(outputs.stages(), Stage::kStep);
                const double end_time = particles.time() + static_cast<double>(scene.dt);
                if (moves) {
                    textures.setPoses(posesAt(scene, end_time));
                }
                RELIEF_TRY(live.show(end_time, textures));
                particles.step(scene.dt);
            }
            ++step;
            if (outputs.log && (step % stats_every == 0 || step == scene.steps)) {
                RELIEF_TRY(outputs.log->request(particles, step, refused));
            }
        }
        RELIEF_TRY(waitForGpu(steps));
        // A step has no result of its own: births that found no room would be missing in silence.
        RELIEF_TRY(checkAllocated(steps, "choose a smaller capacity"));
        rest(options);
        const Clock::duration stretch = Clock::now() - begun;
        if (stretch > kStretchMax) {
            at_once = std::max(at_once / 2, 1U);
        }
        spent += stretch;
        if (step > first) {
            stretches.push_back(std::chrono::duration<double, std::milli>(stretch).count() / (step - first));
        }
        if (outputs.log) {
            RELIEF_TRY(outputs.log->poll());
        }
        if (options.progress) {
            options.progress(step, scene.steps);
        }
        if (has_frames && (step % scene.render.every == 0 || step == scene.steps)) {
            RELIEF_TRY(writeFrame(options, particles, outputs, report));
        }
        if (scene.steps == 0) {
            break;
        }
    }
    if (step > 0) {
        report.ms_per_step = std::chrono::duration<double, std::milli>(spent).count() / step;
    }
    report.ms_per_step_median = median(std::move(stretches));
    report.counts = particles.counts();
    report.counts.refused += refused;
    if (outputs.log) {
        feed(options, "the statistics");
        RELIEF_TRY(outputs.log->finish());
        rest(options);
    }
    if (outputs.timer) {
        report.stage_times = outputs.timer->times();
    }
    return outputs.video ? outputs.video->finish() : Result<void>{};
}

Result<void> readBack(const PlayerOptions& options, const ParticleSystem& particles, PlayerReport& report) {
    feed(options, "reading particles back");
    const auto state = particles.readState();
    rest(options);
    if (!state) {
        return forward(state);
    }
    std::uint64_t collisions = 0;
    std::uint32_t in_contact = 0;
    for (const ParticleState& particle : *state) {
        collisions += particle.collisions;
        in_contact += particle.contact == Contact::kNone ? 0 : 1;
    }
    report.collisions = collisions;
    report.in_contact = in_contact;
    return options.dump.empty() ? Result<void>{} : writeFile(options.dump, encodePly(*state));
}

}  // namespace

Result<PlayerReport> play(const PlayerOptions& options) {
    // What can fail cheaply comes first.
    auto loaded = RELIEF_TRY(loadAll(options.input, options.overrides));
    auto emitters = RELIEF_TRY(makeEmitters(loaded.scene.emitters));
    if (!options.dump.empty()) {
        RELIEF_TRY(checkDumpFolder(options.dump));
    }

    feed(options, "making a context");
    auto context = GlContext::create({options.api, GlPlatform::kAny, options.device});
    rest(options);
    if (!context) {
        return forward(context);
    }
    if (options.watchdog != nullptr && options.default_timeout) {
        options.watchdog->setLimit(defaultGpuTimeout((*context)->software()));
    }
    PlayerReport report;
    report.scene = loaded.scene;
    report.device = (*context)->description();
    feed(options, "uploading the collider");
    auto textures = makeTextures(report.scene, loaded.colliders);
    if (!textures) {
        return fail(textures.error().code,
                    quotedPath(report.scene.colliders.front().path) + ": " + textures.error().message);
    }
    report.collider_maps = static_cast<std::size_t>(textures->mapCount());
    report.collider_bytes = textures->bytes();
    feed(options, "the shaders of colliders");
    auto live = RELIEF_TRY(LiveBodies::create(loaded));
    RELIEF_TRY(live.show(0.0, *textures));
    feed(options, "the shaders of particles");
    auto particles = RELIEF_TRY(makeParticles(report.scene, *textures));
    rest(options);
    Outputs outputs;
    const WithoutCleanUp at_end(options.watchdog);  // before the video goes
    RELIEF_TRY(openOutputs(options, report.scene, loaded, *textures, outputs));
    RELIEF_TRY(run(options, emitters, *textures, live, particles, outputs, report));
    if (options.count_collisions || !options.dump.empty()) {
        RELIEF_TRY(readBack(options, particles, report));
    }
    return report;
}

}  // namespace relief
