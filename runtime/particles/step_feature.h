// SPDX-License-Identifier: Apache-2.0
// The interface of features, which extend the step of a particle system: defines and inputs of its program, and outputs
// in addition to the state. runtime/air adds wind and force fields; runtime/events records hits and deaths.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>

#include "formats/base/result.h"
#include "runtime/collider/shader_collider.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class StepFeature {
  public:
    StepFeature() = default;
    StepFeature(const StepFeature&) = delete;
    StepFeature& operator=(const StepFeature&) = delete;
    virtual ~StepFeature() = default;

    /// Returns `#define` lines for makeProgram(); they make shaders/particles/step.frag include the feature's GLSL.
    [[nodiscard]] virtual std::string defines() const = 0;
    /// Returns whether the step reads the collider's materials for this feature.
    [[nodiscard]] virtual bool readsMaterials() const { return false; }
    /// Fails if the feature does not support this collider; null: none.
    [[nodiscard]] virtual Result<void> check(const ShaderCollider* /*collider*/) const { return {}; }

    /// Connects the program. Called once after linking; the program is current.
    virtual void attach(const GlProgram& /*program*/) const {}
    /// Binds the inputs of a step that ends at `time`, seconds; the program is current.
    virtual void bind(const GlProgram& /*program*/, double /*time*/) const {}
    /// Returns the textures that the step writes in addition to the state: outputs 2, 3, … of the program.
    [[nodiscard]] virtual std::span<const GlTexture> outputs() const { return {}; }
    /// Returns the air velocity that the feature applies in place of Forces::wind, if any.
    [[nodiscard]] virtual std::optional<glm::vec3> wind() const { return std::nullopt; }

    /// Called for each birth: the index, and the id of the previous particle there; 0 if there was none.
    virtual void replaced(std::uint32_t /*index*/, std::uint32_t /*id*/) {}
    /// Called before a step from `begin` to `end`, seconds, of the first `extent` particles; `collider` is null if
    /// there is none.
    virtual void beforeStep(double /*begin*/, double /*end*/, std::uint32_t /*extent*/,
                            const ShaderCollider* /*collider*/) {}
};

}  // namespace relief
