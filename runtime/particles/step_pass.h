// SPDX-License-Identifier: Apache-2.0
// The program of a simulation step, compiled only for the features that a scene uses (shaders/particles/step.glsl).
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
    glm::vec3 gravity{0.0F};  ///< world units/s²
    glm::vec3 wind{0.0F};     ///< velocity of the air, world units/s
    float drag = 0.0F;        ///< a = drag / mass · (wind − v); mass/s, ≥ 0
    float viscosity = 0.0F;   ///< if above 0, Stokes drag 6π · viscosity · radius replaces `drag`
};

/// Returns the rate at which a type adopts the velocity of the air, 1/s.
[[nodiscard]] float dragRate(const Forces& forces, const ParticleType& type);

/// Returns the rate of Stokes drag, k = 6π · viscosity · radius / mass, 1/s,
/// for v' = (v + dt (a + k air)) / (1 + dt k).
/// \param mass  > 0
[[nodiscard]] float stokesRate(float viscosity, float radius, float mass);

/// Compile-time parameters. A change of any member requires another program.
struct StepVariant {
    const ShaderCollider* collider = nullptr;       ///< null: only the floor is solid
    std::vector<const StepFeature*> features = {};  ///< all features, in the order of their outputs
    bool verlet = false;
    bool sweep = false;
    bool radius = false;   ///< at least one type has a radius
    bool compute = false;  ///< compile a compute shader, for dispatch()
    bool masks = false;    ///< at least one type does not collide with everything
    int types = 1;
    friend bool operator==(const StepVariant&, const StepVariant&) = default;
};

/// A file in shaders/ with the program of a step, and its defines.
struct StepShader {
    const char* file = "particles/step.frag";
    std::string defines;
};

class StepPass {
  public:
    /// Maximum pieces of a path that a swept step tests.
    static constexpr int kSweepPieces = 32;

    // Texture units of the inputs; the collider's units follow.
    static constexpr int kPositionUnit = 0;
    static constexpr int kVelocityUnit = 1;
    static constexpr int kBirthUnit = 2;
    static constexpr ShaderCollider::Binding kColliderBinding{3, 0};

    struct Values {
        float now = 0.0F;  ///< seconds on the GPU's clock, at the end of the step
        float dt = 0.0F;
        float ground = 0.0F;
        float sweep = 0.0F;
        double time = 0.0;  ///< the same instant as `now`, as ParticleSystem::time(), seconds
        Forces forces;
        std::span<const ParticleType> types;
    };

    StepPass() = default;
    /// Starts to compile the program.
    /// \param variant  points to its collider and features, which must outlive the pass.
    /// \param shader  includes particles/step.glsl. If it defines its own solids, `variant` has no collider.
    /// Errors: kFailure (a shader file is missing).
    [[nodiscard]] static Result<StepPass> start(StepVariant variant, const StepShader& shader = {});

    /// Waits until the program is compiled; no effect if it is. Call it before the functions below.
    /// Errors: kFailure (shader compilation).
    [[nodiscard]] Result<void> finish();

    /// Makes the program current, sets its uniforms, and binds the collider's textures. If usesStorage(), also binds
    /// the collider's uniform block as shader storage, at kTourStorage.
    void use(const Values& values) const;
    /// Steps the particles in the first `rows` rows of `width` texels into a framebuffer's textures. Call use() first.
    void draw(GLuint framebuffer, std::uint32_t width, std::uint32_t rows) const;
    /// Like draw(), for StepVariant::compute. Writes to image units 0 (positions), 1 (velocities) and the following
    /// ones (outputs of the features).
    void dispatch(std::uint32_t width, std::uint32_t rows) const;
    [[nodiscard]] const StepVariant& variant() const { return variant_; }
    [[nodiscard]] const GlProgram& program() const { return program_; }
    [[nodiscard]] bool usesStorage() const { return tours_; }

  private:
    StepVariant variant_;
    bool tours_ = false;
    StartedProgram started_;
    GlProgram program_;
};

}  // namespace relief
