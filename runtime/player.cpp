#include "runtime/player.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <system_error>
#include <vector>

#include "formats/container.h"
#include "formats/file_io.h"
#include "runtime/collider_renderer.h"
#include "runtime/frame.h"
#include "runtime/particle_renderer.h"
#include "runtime/ply.h"
#include "runtime/png.h"
#include "runtime/scene_pictures.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// Steps between two calls of PlayerOptions::progress, and between two waits for the GPU: without them a
// driver would be handed a whole run at once.
constexpr std::uint32_t kStepsAtOnce = 16;

std::string lowerCaseExtension(const fs::path& path) {
    std::string extension = path.extension().native();
    for (char& c : extension) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return extension;
}

Result<Scene> openScene(const fs::path& input) {
    const std::string extension = lowerCaseExtension(input);
    if (extension == ".toml") {
        return loadScene(input);
    }
    if (extension == ".relief") {
        Scene scene;
        scene.collider = input;
        return scene;
    }
    return fail(ErrorCode::kUsage,
                quotedPath(input) + " is neither a scene nor a collider; name a .toml or a .relief file");
}

Result<Collider> openCollider(const Scene& scene) {
    auto collider = loadCollider(scene.collider);
    if (!collider && !scene.collider_origin.empty()) {
        return fail(collider.error().code,
                    scene.collider_origin + ": collider.file: " + collider.error().message);
    }
    return collider;
}

/// Makes the folder, and sees early that it can be written: a run may take long.
Result<void> prepareFolder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error || !fs::is_directory(folder, error)) {
        return fail(ErrorCode::kIo, "cannot make the folder " + quotedPath(folder) + " for frames: " +
                                        (error ? error.message() : "a file of that name is in the way") +
                                        "; choose another with --frames");
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
    static Result<Picture> create(const Scene& scene, const Collider& collider,
                                  const ColliderTextures& textures) {
        const ColliderView view{&textures, collider.bounds, finestTexel(collider)};
        auto frame = Frame::create(scene.render.width, scene.render.height);
        if (!frame) {
            return forward(frame);
        }
        auto atlas = loadAtlas(scene);
        if (!atlas) {
            return forward(atlas);
        }
        auto mesh = loadColliderMesh(scene, collider.bounds);
        if (!mesh) {
            return forward(mesh);
        }
        auto collider_renderer = ColliderRenderer::create(view, mesh->get());
        if (!collider_renderer) {
            return forward(collider_renderer);
        }
        auto particle_renderer = ParticleRenderer::create(view);
        if (!particle_renderer) {
            return forward(particle_renderer);
        }
        Picture picture{std::move(*frame), std::move(*collider_renderer), std::move(*particle_renderer)};
        picture.scene_ = &scene;
        picture.bounds_ = collider.bounds;
        if (scene.ground.enabled) {
            picture.collider_style_.ground = scene.ground.height;
        }
        picture.collider_style_.background = scene.render.background;
        picture.particle_style_ = particleStyle(scene, atlas->get());
        picture.atlas_ = std::move(*atlas);
        picture.mesh_ = std::move(*mesh);
        return picture;
    }

    Result<std::vector<std::byte>> draw(const ParticleSystem& particles) {
        const Camera camera = sceneCamera(*scene_, bounds_, particles.time());
        if (auto drawn = collider_.draw(camera, collider_style_, frame_.target()); !drawn) {
            return forward(drawn);
        }
        if (auto drawn = particles_.draw(particles, camera, particle_style_, frame_.target(), nullptr,
                                         &collider_.depth());
            !drawn) {
            return forward(drawn);
        }
        return encodePng(frame_.read(), frame_.width(), frame_.height());
    }

  private:
    Picture(Frame frame, ColliderRenderer collider, ParticleRenderer particles)
        : frame_(std::move(frame)), collider_(std::move(collider)), particles_(std::move(particles)) {}

    const Scene* scene_ = nullptr;  // outlives the picture
    Bounds bounds_;
    std::unique_ptr<SpriteAtlas> atlas_;
    std::unique_ptr<ColliderMesh> mesh_;
    Frame frame_;
    ColliderRenderer collider_;
    ParticleRenderer particles_;
    ColliderStyle collider_style_;
    ParticleStyle particle_style_;
};

fs::path framePath(const fs::path& folder, std::uint32_t number) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "frame_%04u.png", number);
    return folder / name.data();
}

Result<ParticleSystem> makeParticles(const Scene& scene, const ColliderTextures& textures) {
    auto particles = ParticleSystem::create({.capacity = scene.capacity});
    if (!particles) {
        return particles;
    }
    const std::array<ColliderInstance, 1> colliders{ColliderInstance{&textures}};
    if (auto done = particles->setColliders(colliders); !done) {
        return forward(done);
    }
    particles->setForces({*scene.forces.gravity, scene.forces.wind, scene.forces.drag});
    particles->setCollision(scene.collision);
    particles->setGround(scene.ground.enabled ? scene.ground.height : std::nullopt);
    return particles;
}

EmitterSettings emitterSettings(const Scene& scene) {
    EmitterSettings settings;
    settings.box_min = *scene.emitter.box_min;
    settings.box_max = *scene.emitter.box_max;
    settings.rate = *scene.emitter.rate;
    settings.duration = scene.emitter.duration.value_or(settings.duration);
    settings.burst = scene.emitter.burst;
    settings.velocity = *scene.emitter.velocity;
    settings.velocity_spread = *scene.emitter.velocity_spread;
    settings.lifetime_min = scene.emitter.lifetime_min;
    settings.lifetime_max = scene.emitter.lifetime_max;
    return settings;
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

/// The run itself: steps and, between them, frames.
Result<void> run(const PlayerOptions& options, ParticleSystem& particles, std::optional<Picture>& picture,
                 PlayerReport& report) {
    const Scene& scene = report.scene;
    Emitter emitter(emitterSettings(scene), scene.emitter.seed);
    std::vector<Birth> births;
    std::uint64_t refused = 0;
    Clock::duration spent{};
    std::vector<double> stretches;  // ms per step of each
    std::uint32_t step = 0;
    while (step < scene.steps || (step == 0 && picture)) {
        const std::uint32_t next_frame =
            picture ? step + scene.render.every - step % scene.render.every : scene.steps;
        const std::uint32_t end = std::min({scene.steps, next_frame, step + kStepsAtOnce});
        const Clock::time_point begun = Clock::now();
        const std::uint32_t first = step;
        for (; step < end; ++step) {
            births.clear();
            refused += emitter.emit(static_cast<double>(scene.dt), particles.room(), births);
            particles.spawn(births);
            particles.step(scene.dt);
        }
        glFinish();
        const Clock::duration stretch = Clock::now() - begun;
        spent += stretch;
        if (step > first) {
            stretches.push_back(std::chrono::duration<double, std::milli>(stretch).count() / (step - first));
        }
        if (options.progress) {
            options.progress(step, scene.steps);
        }
        if (picture && (step % scene.render.every == 0 || step == scene.steps)) {
            auto png = picture->draw(particles);
            if (!png) {
                return forward(png);
            }
            if (auto written = writeFile(framePath(options.frames, report.frames_written), *png); !written) {
                return written;
            }
            ++report.frames_written;
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
    return {};
}

Result<void> readBack(const PlayerOptions& options, const ParticleSystem& particles, PlayerReport& report) {
    const auto state = particles.readState();
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
    auto scene = openScene(options.input);
    if (!scene) {
        return forward(scene);
    }
    scene->steps = options.steps.value_or(scene->steps);
    scene->render.width = options.width.value_or(scene->render.width);
    scene->render.height = options.height.value_or(scene->render.height);
    scene->emitter.seed = options.seed.value_or(scene->emitter.seed);
    auto collider = openCollider(*scene);
    if (!collider) {
        return forward(collider);
    }
    auto complete = withDefaults(std::move(*scene), collider->bounds);
    if (!complete) {
        return fail(complete.error().code, quotedPath(options.input) + ": " + complete.error().message);
    }
    if (!options.dump.empty()) {
        if (auto done = checkDumpFolder(options.dump); !done) {
            return forward(done);
        }
    }

    auto context = GlContext::create(options.api);
    if (!context) {
        return forward(context);
    }
    PlayerReport report;
    report.scene = std::move(*complete);
    report.device = (*context)->description();
    auto textures = ColliderTextures::create(*collider);
    if (!textures) {
        return fail(textures.error().code,
                    quotedPath(report.scene.collider) + ": " + textures.error().message);
    }
    report.collider_maps = collider->maps.size();
    report.collider_bytes = textures->bytes();
    auto particles = makeParticles(report.scene, *textures);
    if (!particles) {
        return forward(particles);
    }
    std::optional<Picture> picture;
    if (!options.frames.empty()) {
        auto made = Picture::create(report.scene, *collider, *textures);
        if (!made) {
            return forward(made);
        }
        picture = std::move(*made);
        if (auto done = prepareFolder(options.frames); !done) {
            return forward(done);
        }
    }
    if (auto done = run(options, *particles, picture, report); !done) {
        return forward(done);
    }
    if (options.count_collisions || !options.dump.empty()) {
        if (auto done = readBack(options, *particles, report); !done) {
            return forward(done);
        }
    }
    return report;
}

}  // namespace relief
