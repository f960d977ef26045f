// SPDX-License-Identifier: Apache-2.0
// Options of a run of the player, and its report.
#pragma once

#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/file_guard.h"
#include "runtime/gl/gl_context.h"
#include "runtime/particles/particle_system.h"
#include "runtime/player/watchdog.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

struct GpuOptions {
    GlApi api = GlApi::kGl33Core;
    std::optional<std::size_t> device;  ///< whether there is such a device shows when a context is made
    std::optional<double> timeout;      ///< seconds; 0: never

    /// In whole milliseconds, rounded up, for 0 means never. A software renderer does not hang, it takes its time.
    [[nodiscard]] std::chrono::milliseconds limit(bool software) const {
        return std::chrono::milliseconds(
            static_cast<std::int64_t>(std::ceil(timeout.value_or(software ? 600.0 : 60.0) * 1000.0)));
    }
};

void fields(FieldVisitor& visit, GpuOptions& options);

/// Format of dumped particles.
enum class DumpFormat : std::uint8_t { kPly, kVdb };

struct PlayerOptions {
    /// A scene (.toml), or a collider (.relief) or a world (.json), for which the default scene is played.
    std::filesystem::path input;
    SceneOverrides overrides;
    /// Knows what else the program reads and writes, a report on standard output for one.
    FileGuard guard;
    /// Folder for frame_0000.png and so on, made if missing; empty: no pictures.
    std::filesystem::path frames;
    std::filesystem::path dump;  ///< the final particles, "-" for standard output; empty: none
    /// Folder for particles_0000.ply and so on, as often as frames; empty: none.
    std::filesystem::path dump_frames;
    DumpFormat dump_format = DumpFormat::kPly;  ///< of both
    std::filesystem::path
        events;  ///< hits as lines of JSON (events_log.h), "-" for standard output; empty: none
    std::optional<float> events_min_speed;  ///< slower hits are left out; nullopt: none
    GpuOptions gpu;
    StepPath path = StepPath::kAuto;
    Watchdog* watchdog = nullptr;  ///< fed while the GPU works; or null
    std::function<void(std::uint32_t step, std::uint32_t steps)> progress;  ///< now and then; may be empty
};

struct PlayerReport {
    Scene scene;                          ///< as played: overridden by the options, every default filled in
    std::string device;                   ///< GlContext::description()
    StepPath path = StepPath::kFragment;  ///< that was taken: not kAuto
    std::size_t collider_maps = 0;
    std::size_t collider_bytes = 0;  ///< of textures on the GPU
    ParticleCounts counts;
    /// Steps in contact, summed over the particles alive at the end.
    std::uint64_t collisions = 0;
    std::uint32_t in_contact = 0;  ///< alive particles that touched something in the last step
    double ms_per_step = 0.0;      ///< wall clock, births and waiting for the GPU included; 0 without steps
    /// The same, as the median over stretches of up to 16 steps: without the first, in which a driver still
    /// compiles, wherever there are three or more. 0 without steps.
    double ms_per_step_median = 0.0;
    std::uint32_t frames_written = 0;   ///< pictures
    std::uint32_t dumps_written = 0;    ///< of dump_frames
    std::vector<std::string> warnings;  ///< what is probably not meant; one line each
    std::uint64_t events_dropped = 0;   ///< hits that a step's list had no room for
};

}  // namespace relief
