// SPDX-License-Identifier: Apache-2.0
// The program of one simulation step, compiled for what a scene uses and no more (shaders/particles/step.glsl).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/base/result.h"
#include "runtime/collider/shader_collider.h"
#include "runtime/gl/gl_object.h"
#include "runtime/particles/particle_type.h"
#include "runtime/particles/step_feature.h"

namespace relief {

struct Forces {
    glm::vec3 gravity{0.0F};  ///< world units a second squared
    glm::vec3 wind{0.0F};     ///< velocity of the air, world units a second
    float drag = 0.0F;        ///< a = drag / mass · (wind − v); mass/s, ≥ 0
    float viscosity = 0.0F;   ///< above 0: Stokes drag 6π · viscosity · radius instead of `drag`
};

/// The rate at which a type takes on the velocity of the air, 1/s.
[[nodiscard]] float dragRate(const Forces& forces, const ParticleType& type);

/// k = 6π · viscosity · radius / mass, 1/s: the rate of Stokes drag, for
/// v' = (v + dt (a + k air)) / (1 + dt k).
/// \param mass  > 0
[[nodiscard]] float stokesRate(float viscosity, float radius, float mass);

/// What the program is compiled for. A change of any of these needs another program.
struct StepVariant {
    const ShaderCollider* collider = nullptr;       ///< null: nothing solid but the floor
    std::vector<const StepFeature*> features = {};  ///< those with outputs in their order
    bool verlet = false;
    bool sweep = false;
    bool radius = false;   ///< some type has a radius
    bool compute = false;  ///< the program is a compute shader: dispatch()
    bool masks = false;    ///< some type does not collide with all
    int types = 1;
    friend bool operator==(const StepVariant&, const StepVariant&) = default;
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
    static constexpr ShaderCollider::Binding kColliderBinding{3, 0};

    struct Values {
        float now = 0.0F;  ///< seconds on the GPU's clock, at the end of the step
        float dt = 0.0F;
        float ground = 0.0F;
        float sweep = 0.0F;
        double time = 0.0;  ///< the same moment, seconds since time 0
        Forces forces;
        std::span<const ParticleType> types;
    };

    StepPass() = default;
    /// \param variant  points to its collider and features, which must outlive the pass.
    /// \param shader  with solids of its own it includes particles/step.glsl, and `variant` has no collider.
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] static Result<StepPass> create(StepVariant variant, const StepShader& shader = {});

    /// Makes the program current and sets its uniforms; binds the collider's textures, and where usesStorage() shader storage
    /// binding kTourStorage.
    void use(const Values& values) const;
    /// After use(): steps the particles of the first `rows` rows of `width` texels into a framebuffer's textures.
    void draw(GLuint framebuffer, std::uint32_t width, std::uint32_t rows) const;
    /// The same with StepVariant::compute: steps the particles of the first `rows` rows of `width` texels into image
    /// units 0 (positions) and 1 (velocities), and the features' outputs into the next ones.
    void dispatch(std::uint32_t width, std::uint32_t rows) const;
    [[nodiscard]] const StepVariant& variant() const { return variant_; }
    [[nodiscard]] const GlProgram& program() const { return program_; }
    [[nodiscard]] bool usesStorage() const { return tours_; }

  private:
    StepVariant variant_;
    bool tours_ = false;
    GlProgram program_;
};

}  // namespace relief
