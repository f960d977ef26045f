#include "runtime/player/outputs.h"

#include <string>
#include <utility>

#include "formats/base/file_io.h"
#include "formats/base/numbered_files.h"
#include "formats/base/preflight.h"
#include "runtime/files/ply.h"
#include "runtime/files/png.h"
#include "runtime/player/watched.h"
#include "runtime/vdb/vdb_writer.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

NumberedFiles pictureFiles(const PlayerOptions& options, std::uint32_t count) {
    return {options.frames, "frame_", ".png", count};
}

NumberedFiles dumpFiles(const PlayerOptions& options, std::uint32_t count) {
    const char* const ending = options.dump_format == DumpFormat::kVdb ? ".vdb" : ".ply";
    return {options.dump_frames, "particles_", ending, count};
}

}  // namespace

Result<void> checkOutputs(const PlayerOptions& options, FileGuard& guard) {
    if (options.dump_format == DumpFormat::kVdb && !(options.dump.empty() && options.dump_frames.empty())) {
        RELIEF_TRY(checkVdb());
    }
    RELIEF_TRY(guard.reads(options.input));
    RELIEF_TRY(guard.writes(options.dump, "--dump"));
    RELIEF_TRY(guard.writes(options.stats, "--stats"));
    return guard.writes(options.events, "--events");
}

Result<void> checkFrames(const PlayerOptions& options, const Scene& scene, FileGuard& guard) {
    for (const fs::path& file : filesOf(scene)) {
        RELIEF_TRY(guard.reads(file));
    }
    const std::uint32_t count = frameCount(scene);
    if (!options.frames.empty()) {
        RELIEF_TRY(guard.writes(pictureFiles(options, count), "--frames"));
    }
    return options.dump_frames.empty() ? Result<void>{}
                                       : guard.writes(dumpFiles(options, count), "--dump-frames");
}

Outputs::~Outputs() {
    if (options_.watchdog != nullptr) {
        options_.watchdog->rest();
    }
}

Result<void> Outputs::open() {
    const Scene& scene = loaded_.scene;
    if (!options_.frames.empty()) {
        picture_ = RELIEF_TRY(watched(options_.watchdog, "the shaders of pictures", [&] {
            return ScenePicture::create(loaded_, textures_, options_.path);
        }));
    }
    if (options_.time_stages || !options_.stats.empty()) {
        timer_.emplace();
    }
    if (!options_.stats.empty()) {
        log_ = RELIEF_TRY(StatisticsLog::create(options_.stats, scene.particles.capacity, *timer_));
    }
    if (!options_.events.empty()) {
        events_ = RELIEF_TRY(EventsLog::create(options_.events, options_.events_min_speed.value_or(0.0F)));
    }
    if (!options_.frames.empty()) {
        RELIEF_TRY(preflightFolder(options_.frames, "--frames"));
    }
    return options_.dump_frames.empty() ? Result<void>{}
                                        : preflightFolder(options_.dump_frames, "--dump-frames");
}

Result<std::vector<std::byte>> encodeDump(std::span<const ParticleState> particles, DumpFormat format) {
    return format == DumpFormat::kVdb ? encodeVdbPoints(particles) : encodePly(particles);
}

Result<void> Outputs::writeFrame(const ParticleSystem& particles, PlayerReport& report) {
    if (picture_) {
        RELIEF_TRY(writePicture(particles, report));
    }
    return options_.dump_frames.empty() ? Result<void>{} : writeParticles(particles, report);
}

Result<void> Outputs::writePicture(const ParticleSystem& particles, PlayerReport& report) {
    const auto rgb = RELIEF_TRY(watched(options_.watchdog, "picture " + std::to_string(report.frames_written),
                                        [&] { return picture_->draw(particles, timer()); }));
    const auto& render = loaded_.scene.render;
    const auto png = RELIEF_TRY(encodePng(rgb, render.width, render.height));
    RELIEF_TRY(writeFile(pictureFiles(options_, report.frames_written + 1).path(report.frames_written), png));
    ++report.frames_written;
    return {};
}

Result<void> Outputs::writeParticles(const ParticleSystem& particles, PlayerReport& report) {
    const auto state = RELIEF_TRY(
        watched(options_.watchdog, "reading particles back", [&] { return particles.readState(); }));
    const fs::path path = dumpFiles(options_, report.dumps_written + 1).path(report.dumps_written);
    const auto bytes = RELIEF_TRY(encodeDump(state, options_.dump_format));
    RELIEF_TRY(writeFile(path, bytes));
    ++report.dumps_written;
    return {};
}

Result<void> Outputs::finish() {
    if (log_) {
        RELIEF_TRY(watched(options_.watchdog, "the statistics", [&] { return log_->finish(); }));
    }
    if (events_) {
        RELIEF_TRY(events_->finish());
    }
    return {};
}

}  // namespace relief
