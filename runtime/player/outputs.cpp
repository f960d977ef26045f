#include "runtime/player/outputs.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

#include "formats/base/file_io.h"
#include "runtime/files/ply.h"
#include "runtime/files/png.h"
#include "runtime/player/watched.h"
#include "runtime/vdb/vdb_points.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// Makes the folder, and checks early that it can be written: a run may take long.
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

/// "frame_", 7, ".png" -> folder/frame_0007.png
fs::path numberedPath(const fs::path& folder, const char* head, std::uint32_t number, const char* ending) {
    std::array<char, 48> name{};
    std::snprintf(name.data(), name.size(), "%s%04u%s", head, number, ending);
    return folder / name.data();
}

/// The frame rate at which a video plays in the scene's time, within what players can show.
double videoRate(const Scene& scene) {
    return std::clamp(1.0 / (static_cast<double>(scene.dt) * scene.render.every), 1.0, 120.0);
}

}  // namespace

Result<void> checkDump(const PlayerOptions& options) {
    const fs::path& dump = options.dump;
    if (options.dump_format == DumpFormat::kVdb && !(dump.empty() && options.dump_frames.empty())) {
        RELIEF_TRY(checkVdb());
    }
    if (dump.empty()) {
        return {};
    }
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

Outputs::~Outputs() {
    if (options_.watchdog != nullptr) {
        options_.watchdog->rest();
        options_.watchdog->setCleanUp({});
    }
}

Result<void> Outputs::open() {
    const Scene& scene = loaded_.scene;
    if (!options_.frames.empty() || !options_.video.empty()) {
        picture_ = RELIEF_TRY(watched(options_.watchdog, "the shaders of pictures", [&] {
            return ScenePicture::create(loaded_, textures_, options_.path);
        }));
    }
    if (!options_.video.empty()) {
        RELIEF_TRY(openVideo());
    }
    if (options_.time_stages || !options_.stats.empty()) {
        timer_.emplace();
    }
    if (!options_.stats.empty()) {
        log_ = RELIEF_TRY(StatisticsLog::create(options_.stats, scene.capacity, options_.path, *timer_));
    }
    if (!options_.events.empty()) {
        events_ = RELIEF_TRY(EventsLog::create(options_.events, options_.events_min_speed.value_or(0.0F)));
    }
    if (!options_.frames.empty()) {
        RELIEF_TRY(prepareFolder(options_.frames, "--frames"));
    }
    return options_.dump_frames.empty() ? Result<void>{}
                                        : prepareFolder(options_.dump_frames, "--dump-frames");
}

Result<std::vector<std::byte>> encodeDump(std::span<const ParticleState> particles, DumpFormat format) {
    return format == DumpFormat::kVdb ? encodeVdbPoints(particles) : encodePly(particles);
}

Result<void> Outputs::openVideo() {
    const Scene& scene = loaded_.scene;
    video_ = RELIEF_TRY(
        VideoWriter::create(options_.video, {scene.render.width, scene.render.height, videoRate(scene)}));
    if (options_.watchdog != nullptr) {
        options_.watchdog->setCleanUp([writer = video_.get()] { writer->abandon(); });
    }
    return {};
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
    if (!options_.frames.empty()) {
        const auto& render = loaded_.scene.render;
        const auto png = RELIEF_TRY(encodePng(rgb, render.width, render.height));
        RELIEF_TRY(writeFile(numberedPath(options_.frames, "frame_", report.frames_written, ".png"), png));
    }
    if (video_) {
        RELIEF_TRY(video_->add(rgb));
    }
    ++report.frames_written;
    return {};
}

Result<void> Outputs::writeParticles(const ParticleSystem& particles, PlayerReport& report) {
    const auto state = RELIEF_TRY(
        watched(options_.watchdog, "reading particles back", [&] { return particles.readState(); }));
    const char* const ending = options_.dump_format == DumpFormat::kVdb ? ".vdb" : ".ply";
    const fs::path path = numberedPath(options_.dump_frames, "particles_", report.dumps_written, ending);
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
    return video_ ? video_->finish() : Result<void>{};
}

}  // namespace relief
