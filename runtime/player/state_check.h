// Watches over a run: no particle may leave what floats hold.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "formats/base/result.h"
#include "runtime/particles/statistics.h"
#include "runtime/scene/scene.h"

namespace relief {

/// Sums up the particles now and then (kStateCheckSteps), beside the steps and without waiting for the GPU.
class StateCheck {
  public:
    /// \param input, scene  the scene as played, and its file; must outlive this.
    /// \param path  how the sums are made: that of the steps.
    /// Errors: those of Statistics::create.
    [[nodiscard]] static Result<StateCheck> create(const std::filesystem::path& input, const Scene& scene);

    /// Looks at the particles after this step, if the last look is some steps ago or the run is at its end, and judges
    /// what the GPU has answered.
    /// Errors: kFailure, which names the type of a lost particle with its place in the scene.
    [[nodiscard]] Result<void> look(const ParticleSystem& particles, std::uint32_t step);
    /// Judges the rest, waiting for the GPU. Errors: kFailure.
    [[nodiscard]] Result<void> finish();

  private:
    StateCheck(const std::filesystem::path& input, const Scene& scene, Statistics statistics)
        : input_(&input), scene_(&scene), statistics_(std::move(statistics)) {}
    [[nodiscard]] Result<void> judge(const StatisticsSample& sample) const;

    const std::filesystem::path* input_;
    const Scene* scene_;
    Statistics statistics_;
    std::uint32_t looked_ = 0;  // at the particles after this step
};

}  // namespace relief
