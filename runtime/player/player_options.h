// SPDX-License-Identifier: Apache-2.0
// Options and report of a run.
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
    std::optional<std::size_t> device;  ///< EGL device index, checked when the context is created
    std::optional<double> timeout;      ///< seconds; 0: no limit

    /// Returns the limit in milliseconds. Rounds up, because 0 means no limit.
    /// \param software  whether the renderer is a software renderer, whose default is longer.
    [[nodiscard]] std::chrono::milliseconds limit(bool software) const {
        return std::chrono::milliseconds(
            static_cast<std::int64_t>(std::ceil(timeout.value_or(software ? 600.0 : 60.0) * 1000.0)));
    }
};

void fields(FieldVisitor& visit, GpuOptions& options);

/// Format of dumped particles.
enum class DumpFormat : std::uint8_t { kPly, kVdb };

struct PlayerOptions {
    /// A scene (.toml), or a collider (.relief) or world (.json), for which the default scene runs.
    std::filesystem::path input;
    SceneOverrides overrides;
    /// Tracks all files that the program reads and writes, including standard output.
    FileGuard guard;
    /// Folder for frame_0000.png and so on, created if missing; empty: no pictures.
    std::filesystem::path frames;
    std::filesystem::path dump;  ///< file for the final particles, "-" for standard output; empty: none
    /// Folder for the particles of each frame, particles_0000.ply and so on; empty: none.
    std::filesystem::path dump_frames;
    DumpFormat dump_format = DumpFormat::kPly;  ///< of both dumps
    /// File for hits as lines of JSON (events_log.h), "-" for standard output; empty: none.
    std::filesystem::path events;
    std::optional<float> events_min_speed;  ///< world units/s; slower hits are omitted; nullopt: 0
    GpuOptions gpu;
    StepPath path = StepPath::kAuto;
    Watchdog* watchdog = nullptr;  ///< may be null
    /// Called between steps; may be empty.
    std::function<void(std::uint32_t step, std::uint32_t steps)> progress;
};

struct PlayerReport {
    Scene scene;                          ///< with overrides and all defaults
    std::string device;                   ///< GlContext::description()
    StepPath path = StepPath::kFragment;  ///< the path used, never kAuto
    std::size_t collider_maps = 0;
    std::size_t collider_bytes = 0;  ///< GPU size of the textures
    ParticleCounts counts;
    /// Steps in contact, summed over the particles alive at the end.
    std::uint64_t collisions = 0;
    std::uint32_t in_contact = 0;  ///< live particles in contact in the last step
    /// Mean wall-clock time, including births and waiting for the GPU; 0 without steps.
    double ms_per_step = 0.0;
    /// Median over blocks of up to 16 steps; 0 without steps. Shader compilation in the first block does not affect the
    /// median of three or more blocks.
    double ms_per_step_median = 0.0;
    std::uint32_t frames_written = 0;   ///< number of pictures
    std::uint32_t dumps_written = 0;    ///< number of files in dump_frames
    std::vector<std::string> warnings;  ///< likely errors in the scene; one line each
    std::uint64_t events_dropped = 0;   ///< hits lost because the list of a step was full
};

}  // namespace relief
