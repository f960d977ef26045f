// The outputs of a run in progress: pictures, dumps, statistics; each only if requested.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gpu_timer.h"
#include "runtime/player/logs.h"
#include "runtime/player/player_options.h"
#include "runtime/player/scene_picture.h"

namespace relief {

/// Checks that the options' outputs can be written, as far as that shows before the run, and that none is the input or
/// another output. \param guard  gets to know them.
/// Fails as FileGuard does, and with kUnsupported (OpenVDB).
[[nodiscard]] Result<void> checkOutputs(const PlayerOptions& options, FileGuard& guard);
/// The same with every file that the scene names, and with the numbered files of its frames.
[[nodiscard]] Result<void> checkFrames(const PlayerOptions& options, const Scene& scene, FileGuard& guard);

/// Errors: those of encodeVdbPoints.
[[nodiscard]] Result<std::vector<std::byte>> encodeDump(std::span<const ParticleState> particles,
                                                        DumpFormat format);

class Outputs {
  public:
    /// \param options, loaded, textures  must outlive this.
    Outputs(const PlayerOptions& options, const LoadedScene& loaded, const ColliderTextures& textures)
        : options_(options), loaded_(loaded), textures_(textures) {}
    ~Outputs();
    Outputs(const Outputs&) = delete;
    Outputs& operator=(const Outputs&) = delete;

    /// Makes what is wanted. Fails as ScenePicture and StatisticsLog do; kIo for folders.
    [[nodiscard]] Result<void> open();

    /// Pictures or dumps are written between steps.
    [[nodiscard]] bool hasFrames() const { return picture_ || !options_.dump_frames.empty(); }
    /// A frame of every kind that is wanted, all of the same step; counts them in the report.
    [[nodiscard]] Result<void> writeFrame(const ParticleSystem& particles, PlayerReport& report);
    /// Null without statistics.
    [[nodiscard]] StatisticsLog* log() { return log_ ? &*log_ : nullptr; }
    /// Null without events.
    [[nodiscard]] EventsLog* events() { return events_ ? &*events_ : nullptr; }
    /// Null where stages are not timed.
    [[nodiscard]] GpuTimer* timer() { return timer_ ? &*timer_ : nullptr; }
    /// Ends the statistics and the events.
    [[nodiscard]] Result<void> finish();

  private:
    [[nodiscard]] Result<void> writePicture(const ParticleSystem& particles, PlayerReport& report);
    [[nodiscard]] Result<void> writeParticles(const ParticleSystem& particles, PlayerReport& report);

    const PlayerOptions& options_;
    const LoadedScene& loaded_;
    const ColliderTextures& textures_;
    std::optional<ScenePicture> picture_;
    std::optional<GpuTimer> timer_;
    std::optional<StatisticsLog> log_;
    std::optional<EventsLog> events_;
};

}  // namespace relief
