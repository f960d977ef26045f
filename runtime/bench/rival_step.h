// SPDX-License-Identifier: Apache-2.0
// A particle step that collides by a method other than depth maps, with the same forces, types, uniforms and state as
// Relief's step.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "formats/bricks/brick_atlas.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/bench/mesh_tree.h"
#include "runtime/particles/step_pass.h"

namespace relief {

/// A method to compare depth maps with.
struct Rival {
    struct Texture {
        const char* sampler;  ///< uniform
        GlTexture texture;
        bool volume = false;  ///< 3-D
    };
    StepShader shader;
    std::vector<Texture> textures;
    std::function<void(const GlProgram&)> set;  ///< sets the other uniforms of the current program
    std::uint64_t bytes = 0;                    ///< size of the textures
    /// Adds a float, initially -1, to the state of each particle. The shader reads it from the sampler u_kept and
    /// writes it to fragment output 2 or image unit 2.
    bool keeps = false;
};

/// Uploads a distance volume of bricks. Errors: kLimit (GL limits for bricks or texels), kFailure.
[[nodiscard]] Result<Rival> makeBrickRival(const BrickAtlas& atlas);

/// Uploads a triangle mesh with exact distances. The textures and defines of the rival also fit bench/mesh_query.frag.
/// \param keeps  stores a bound on the distance with each particle, which avoids queries or limits their range. The
///               particles move exactly as without the bound.
/// Errors: kLimit (GL limits), kFailure.
[[nodiscard]] Result<Rival> makeMeshRival(const MeshTree& tree, bool keeps = false);

class RivalStep {
  public:
    /// Creates a system with one particle per birth of the scene.
    /// Errors: kUsage (a number of births that is not a multiple of ParticleSystem::kStateWidth, or an age other than
    /// 0), kUnsupported (no compute shaders), kFailure.
    [[nodiscard]] static Result<RivalStep> create(Rival rival, const BenchScene& scene, StepPath path);

    /// Spawns all particles and runs a first step. Keeps no reference to the scene.
    void begin(const BenchScene& scene);
    void step();
    [[nodiscard]] std::uint64_t bytes() const { return rival_.bytes; }
    [[nodiscard]] const GlTexture& positions() const { return state_[current_][0]; }
    [[nodiscard]] const GlTexture& velocities() const { return state_[current_][1]; }

  private:
    void makeState(const BenchScene& scene);
    Result<void> compile();

    Rival rival_;
    StepPath path_ = StepPath::kFragment;
    std::uint32_t rows_ = 0;
    std::size_t current_ = 0;
    float clock_ = 0.0F;
    Forces forces_;
    std::array<ParticleType, 1> types_;
    std::array<std::vector<GlTexture>, 2> state_;  // position, velocity, and a float if the rival keeps one
    std::array<GlFramebuffer, 2> target_;
    GlTexture birth_;
    StepPass pass_;
};

}  // namespace relief
