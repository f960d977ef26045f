// SPDX-License-Identifier: Apache-2.0
// What a layer adds to the step of a particle system: lines and inputs of its program, outputs beside the state.
// runtime/air moves particles by wind and fields; runtime/events records hits and deaths.
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

    /// Lines for makeProgram, for which shaders/particles/step.frag includes the layer's own file.
    [[nodiscard]] virtual std::string defines() const = 0;
    /// Whether a step reads the materials of its collider for this.
    [[nodiscard]] virtual bool readsMaterials() const { return false; }
    /// Fails where this feature does not go with such a collider, null: none.
    [[nodiscard]] virtual Result<void> check(const ShaderCollider* /*collider*/) const { return {}; }

    /// Connects the program, once after linking; it is current.
    virtual void attach(const GlProgram& /*program*/) const {}
    /// Binds what the step that ends at `time`, seconds, reads; the program is current.
    virtual void bind(const GlProgram& /*program*/, double /*time*/) const {}
    /// The textures that the step writes beside the state, in the order of the program's outputs, which begin at 2.
    [[nodiscard]] virtual std::span<const GlTexture> outputs() const { return {}; }
    /// The velocity of the air where this adds it, which then replaces Forces::wind.
    [[nodiscard]] virtual std::optional<glm::vec3> wind() const { return std::nullopt; }

    /// A birth takes the place of the particle `id`, between two steps.
    virtual void replaced(std::uint32_t /*index*/, std::uint32_t /*id*/) {}
    /// Before a step from `begin` to `end`, seconds, of the first `extent` particles among `collider`, null: none.
    virtual void beforeStep(double /*begin*/, double /*end*/, std::uint32_t /*extent*/,
                            const ShaderCollider* /*collider*/) {}
};

}  // namespace relief
