// SPDX-License-Identifier: Apache-2.0
// The program of one simulation step, compiled for what a scene uses and no more (shaders/particles/step.glsl).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "formats/base/result.h"
#include "runtime/air/air_block.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_type.h"

namespace relief {

struct Forces {
    glm::vec3 gravity{0.0F};  ///< world units a second squared
    glm::vec3 wind{0.0F};     ///< velocity of the air, world units a second
    float drag = 0.0F;        ///< a = drag / mass · (wind − v); mass/s, ≥ 0
    float viscosity = 0.0F;   ///< above 0: Stokes drag 6π · viscosity · radius instead of `drag`
};

/// The rate at which a type takes on the velocity of the air, 1/s.
[[nodiscard]] float dragRate(const Forces& forces, const ParticleType& type);

/// The features that the program is compiled for. A change of any of these needs another one.
struct StepFeatures {
    const ColliderTextures* collider = nullptr;  ///< null: nothing solid but the floor
    const AirBlock* air = nullptr;               ///< null: still, but for the wind of Forces
    bool verlet = false;
    bool sweep = false;
    bool radius = false;   ///< some type has a radius
    bool compute = false;  ///< the program is a compute shader: dispatch()
    bool masks = false;    ///< some type does not collide with all
    int types = 1;
    bool events = false;  ///< writes events, too (shaders/particles/step_event.glsl)
    friend bool operator==(const StepFeatures&, const StepFeatures&) = default;
};

/// A file of shaders/ with the program of a step, and lines for it.
struct StepShader {
    const char* file = "particles/step.frag";
    std::string defines;
};

class StepPass {
  public:
    /// The pieces of way that a swept step is tested at, at most.
    static constexpr int kSweepPieces = 32;

    // Texture units of the inputs; the collider's follow.
    static constexpr int kPositionUnit = 0;
    static constexpr int kVelocityUnit = 1;
    static constexpr int kBirthUnit = 2;
    static constexpr ColliderTextures::Binding kColliderBinding{3, 0};
    static constexpr AirBlock::Binding kAirBinding{6, 1};

    struct Values {
        float now = 0.0F;  ///< seconds on the GPU's clock, at the end of the step
        float dt = 0.0F;
        float ground = 0.0F;
        float sweep = 0.0F;
        float air_time = 0.0F;  ///< as airTime() gives it
        Forces forces;
        std::span<const ParticleType> types;
    };

    StepPass() = default;
    /// \param shader  with solids of its own it includes particles/step.glsl, and `features` has no collider.
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] static Result<StepPass> create(const StepFeatures& features, const StepShader& shader = {});

    /// Makes the program current and sets its uniforms; binds the collider's textures, and where usesStorage() shader storage
    /// binding kTourStorage.
    void use(const Values& values) const;
    /// After use(): steps the particles of the first `rows` rows of `width` texels into a framebuffer's textures.
    void draw(GLuint framebuffer, std::uint32_t width, std::uint32_t rows) const;
    /// The same with StepFeatures::compute: steps the particles of the first `rows` rows of `width` texels into image
    /// units 0 (positions) and 1 (velocities), and with events the next two.
    void dispatch(std::uint32_t width, std::uint32_t rows) const;
    [[nodiscard]] const StepFeatures& features() const { return features_; }
    [[nodiscard]] const GlProgram& program() const { return program_; }
    [[nodiscard]] bool usesStorage() const { return tours_; }

  private:
    StepFeatures features_;
    bool tours_ = false;
    GlProgram program_;
};

}  // namespace relief
