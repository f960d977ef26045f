// SPDX-License-Identifier: Apache-2.0
// Writes the requested outputs of a run: pictures, dumps, hits.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/player/events_log.h"
#include "runtime/player/player_options.h"
#include "runtime/player/scene_picture.h"

namespace relief {

/// Checks that the outputs can be written, as far as this is known before the run, and that no output is the input or
/// another output. \param guard  records the input and the outputs.
/// Errors: those of FileGuard; kUnsupported (no OpenVDB).
[[nodiscard]] Result<void> checkOutputs(const PlayerOptions& options, FileGuard& guard);
/// Like checkOutputs(), for all files that the scene names (allFilesOf()) and the numbered files of --frames and
/// --dump-frames.
[[nodiscard]] Result<void> checkFrames(const PlayerOptions& options, const LoadedScene& loaded,
                                       FileGuard& guard);

class Outputs {
  public:
    /// \param options, loaded, textures  must outlive this.
    Outputs(const PlayerOptions& options, const LoadedScene& loaded, const WorldTextures& textures)
        : options_(options), loaded_(loaded), textures_(textures) {}
    ~Outputs();

    /// Creates renderers, files and folders. Errors: those of ScenePicture and EventsLog; kIo for folders.
    [[nodiscard]] Result<void> open(FileGuard& guard);

    /// Returns whether pictures or dumps are written between steps.
    [[nodiscard]] bool hasFrames() const { return picture_ || !options_.dump_frames.empty(); }
    /// Writes the picture and the dump of the current step, as requested, and counts them in the report.
    [[nodiscard]] Result<void> writeFrame(const ParticleSystem& particles, PlayerReport& report);
    /// Counts collisions and contacts of the final particles in the report, and writes the dump.
    [[nodiscard]] Result<void> writeEnd(const ParticleSystem& particles, PlayerReport& report);
    /// Returns null unless events are written.
    [[nodiscard]] EventsLog* events() { return events_ ? &*events_ : nullptr; }

  private:
    [[nodiscard]] Result<void> writePicture(const ParticleSystem& particles, PlayerReport& report);
    /// Errors: kFailure if isLost() is true for a particle, with the place of its type in the scene.
    [[nodiscard]] Result<std::vector<ParticleState>> readParticles(const ParticleSystem& particles) const;
    [[nodiscard]] Result<void> writeDump(std::span<const ParticleState> particles,
                                         const std::filesystem::path& path) const;

    const PlayerOptions& options_;
    const LoadedScene& loaded_;
    const WorldTextures& textures_;
    std::optional<ScenePicture> picture_;
    std::optional<EventsLog> events_;
};

}  // namespace relief
