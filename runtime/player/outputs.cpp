// SPDX-License-Identifier: Apache-2.0
#include "runtime/player/outputs.h"

#include <algorithm>
#include <string>

#include "formats/base/file_guard.h"
#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/files/ply.h"
#include "runtime/files/png.h"
#include "runtime/player/watchdog.h"
#include "runtime/scene/scene_meshes.h"
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
    return guard.writes(options.events, "--events");
}

Result<void> checkFrames(const PlayerOptions& options, const LoadedScene& loaded, FileGuard& guard) {
    for (const fs::path& file : allFilesOf(loaded)) {
        RELIEF_TRY(guard.reads(file));
    }
    if (!options.frames.empty() && !loaded.scene.render.meshes.empty()) {
        static_cast<void>(RELIEF_TRY(drawnFiles(loaded)));  // detects missing files before the run
    }
    const std::uint32_t count = frameCount(loaded.scene);
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

Result<void> Outputs::open(FileGuard& guard) {
    if (!options_.frames.empty()) {
        picture_ = RELIEF_TRY(watched(options_.watchdog, "the shaders of pictures", [&] {
            return ScenePicture::create(loaded_, textures_, options_.path);
        }));
    }
    if (!options_.events.empty()) {
        events_ = RELIEF_TRY(EventsLog::create(options_.events, options_.events_min_speed.value_or(0.0F)));
    }
    if (!options_.frames.empty()) {
        RELIEF_TRY(guard.makes(options_.frames, "--frames"));
    }
    return options_.dump_frames.empty() ? Result<void>{} : guard.makes(options_.dump_frames, "--dump-frames");
}

Result<void> Outputs::writeFrame(const ParticleSystem& particles, PlayerReport& report) {
    if (picture_) {
        RELIEF_TRY(writePicture(particles, report));
    }
    if (!options_.dump_frames.empty()) {
        const auto path = dumpFiles(options_, report.dumps_written + 1).path(report.dumps_written);
        const auto state = RELIEF_TRY(readParticles(particles));
        RELIEF_TRY(writeDump(state, path));
        ++report.dumps_written;
    }
    return {};
}

Result<void> Outputs::writeEnd(const ParticleSystem& particles, PlayerReport& report) {
    const auto state = RELIEF_TRY(readParticles(particles));
    for (const ParticleState& particle : state) {
        report.collisions += particle.collisions;
        report.in_contact += particle.contact == Contact::kNone ? 0 : 1;
    }
    return options_.dump.empty() ? Result<void>{} : writeDump(state, options_.dump);
}

Result<void> Outputs::writePicture(const ParticleSystem& particles, PlayerReport& report) {
    const auto rgb = RELIEF_TRY(watched(options_.watchdog, "picture " + std::to_string(report.frames_written),
                                        [&] { return picture_->draw(particles); }));
    const auto& render = loaded_.scene.render;
    const auto png = RELIEF_TRY(encodePng(rgb, render.width, render.height));
    RELIEF_TRY(writeFile(pictureFiles(options_, report.frames_written + 1).path(report.frames_written), png));
    ++report.frames_written;
    return {};
}

Result<std::vector<ParticleState>> Outputs::readParticles(const ParticleSystem& particles) const {
    auto state = RELIEF_TRY(
        watched(options_.watchdog, "reading particles back", [&] { return particles.readState(); }));
    const auto lost = std::find_if(state.begin(), state.end(), isLost);
    if (lost == state.end()) {
        return state;
    }
    const std::vector<SceneType>& types = loaded_.scene.types;
    std::string who = quotedPath(options_.input) + ": particles";
    if (!types.empty()) {
        const std::size_t index = std::min<std::size_t>(lost->type, types.size() - 1);
        const std::string& name = types[index].name;
        who = types[index].place + ": particles of " +
              (name.empty() ? "type " + std::to_string(index) : "the type '" + cleanUtf8(name) + "'");
    }
    return fail(ErrorCode::kFailure, who +
                                         " are lost: their position or velocity overflows; lower "
                                         "speeds, strengths, radius · viscosity / mass, or time.dt");
}

Result<void> Outputs::writeDump(std::span<const ParticleState> particles, const fs::path& path) const {
    if (options_.dump_format == DumpFormat::kPly) {
        return writeFile(path, encodePly(particles));
    }
    std::vector<VdbPoint> points;
    points.reserve(particles.size());
    for (const ParticleState& p : particles) {
        points.push_back({p.id, p.position, p.velocity, p.age, p.lifetime, p.type});
    }
    return writeFile(path, RELIEF_TRY(encodeVdbPoints(points)));
}

}  // namespace relief
