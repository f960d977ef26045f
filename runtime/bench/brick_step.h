// SPDX-License-Identifier: Apache-2.0
// A particle step with a brick distance volume as collider, with the same forces, types, uniforms and state as Relief's
// step.
#pragma once

#include <array>
#include <vector>

#include "formats/bricks/brick_atlas.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/particles/step_pass.h"

namespace relief {

class BrickStep {
  public:
    /// Creates a system with one particle per birth of the scene, a multiple of ParticleSystem::kStateWidth.
    /// Errors: kUsage (births with an age above 0), kLimit (GL limits for bricks or texels), kUnsupported (compute),
    /// kFailure.
    [[nodiscard]] static Result<BrickStep> create(const BrickAtlas& atlas, const BenchScene& scene,
                                                  StepPath path);

    /// Spawns all particles and runs a first step. Keeps no reference.
    void begin(const BenchScene& scene);
    void step();
    /// Returns the size of the textures in bytes.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    [[nodiscard]] const GlTexture& positions() const { return state_[current_][0]; }
    [[nodiscard]] const GlTexture& velocities() const { return state_[current_][1]; }

  private:
    Result<void> uploadAtlas(const BrickAtlas& atlas);
    Result<void> compile(const BrickAtlas& atlas);
    void makeState(const BenchScene& scene);

    StepPath path_ = StepPath::kFragment;
    std::uint32_t rows_ = 0;
    std::size_t current_ = 0;
    float clock_ = 0.0F;
    Forces forces_;
    std::array<ParticleType, 1> types_;
    std::array<std::array<GlTexture, 2>, 2> state_;  // position and velocity
    std::array<GlFramebuffer, 2> target_;
    GlTexture birth_;
    bool dense_ = false;
    bool wide_ = false;  // 32 instead of 16 bits per index cell
    glm::ivec3 atlas_bricks_{1};
    GlTexture index_;
    GlTexture atlas_;
    std::uint64_t bytes_ = 0;
    StepPass pass_;
};

}  // namespace relief
