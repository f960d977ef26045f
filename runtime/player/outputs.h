// SPDX-License-Identifier: Apache-2.0
// The outputs of a run in progress: pictures, dumps, hits; each only if requested.
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

/// Checks that the options' outputs can be written, as far as that shows before the run, and that none is the input or
/// another output. \param guard  gets to know them.
/// Fails as FileGuard does, and with kUnsupported (OpenVDB).
[[nodiscard]] Result<void> checkOutputs(const PlayerOptions& options, FileGuard& guard);
/// The same with allFilesOf() the scene, and with the numbered files of its frames.
[[nodiscard]] Result<void> checkFrames(const PlayerOptions& options, const LoadedScene& loaded,
                                       FileGuard& guard);

class Outputs {
  public:
    /// \param options, loaded, textures  must outlive this.
    Outputs(const PlayerOptions& options, const LoadedScene& loaded, const WorldTextures& textures)
        : options_(options), loaded_(loaded), textures_(textures) {}
    ~Outputs();
    Outputs(const Outputs&) = delete;
    Outputs& operator=(const Outputs&) = delete;

    /// Makes what is wanted, folders by the guard. Fails as ScenePicture and EventsLog do; kIo for folders.
    [[nodiscard]] Result<void> open(FileGuard& guard);

    /// Pictures or dumps are written between steps.
    [[nodiscard]] bool hasFrames() const { return picture_ || !options_.dump_frames.empty(); }
    /// A frame of every kind that is wanted, all of the same step; counts them in the report.
    [[nodiscard]] Result<void> writeFrame(const ParticleSystem& particles, PlayerReport& report);
    /// The particles at the end: counts their collisions and contacts in the report, and writes the dump.
    [[nodiscard]] Result<void> writeEnd(const ParticleSystem& particles, PlayerReport& report);
    /// Null without events.
    [[nodiscard]] EventsLog* events() { return events_ ? &*events_ : nullptr; }

  private:
    [[nodiscard]] Result<void> writePicture(const ParticleSystem& particles, PlayerReport& report);
    /// Fails with kFailure where a particle is lost, and names its type by its place in the scene.
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
