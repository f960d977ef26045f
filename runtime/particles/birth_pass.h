// SPDX-License-Identifier: Apache-2.0
// Writes newborn particles into the state textures, as points or with a compute shader.
#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/step_path.h"

namespace relief {

class BirthPass {
  public:
    /// Layout of the shaders' input.
    struct Newborn {
        std::uint32_t index;  ///< texel index, unique
        glm::vec3 position;
        glm::vec3 velocity;
        glm::vec4 birth;  ///< time of birth, time of death, type, id modulo 2^24
    };
    /// The render target, for either path.
    struct Target {
        GLuint framebuffer = 0;  ///< with the three textures as attachments, in order
        const GlTexture& position;
        const GlTexture& velocity;
        const GlTexture& birth;
    };

    BirthPass() = default;
    /// \param size  of the state textures, texels. \param path  not kAuto.
    /// Errors: kFailure (shader compilation).
    [[nodiscard]] static Result<BirthPass> create(const glm::uvec2& size, StepPath path);

    /// Writes the particles. Call it within a PassState.
    void run(std::span<const Newborn> newborn, const Target& target) const;

  private:
    void makeVertexFormat();
    void draw(std::span<const Newborn> newborn, const Target& target) const;
    void dispatch(std::span<const Newborn> newborn, const Target& target) const;

    StepPath path_ = StepPath::kFragment;
    glm::uvec2 size_{0};
    GlBuffer newborn_;
    GlVertexArray array_;  // for drawing points
    GlProgram program_;
};

}  // namespace relief
