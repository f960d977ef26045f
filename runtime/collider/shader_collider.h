// SPDX-License-Identifier: Apache-2.0
// The inputs of shaders that include collider/collider.glsl: a collider in its own object space (ColliderTextures), or a world
// of bodies (runtime/bodies).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "runtime/gl/gl_object.h"

namespace relief {

class ShaderCollider {
  public:
    /// Texture units and the uniform block binding that bind() uses: `first_unit`, + 1, + 2, and for a world one more.
    struct Binding {
        int first_unit = 0;
        int uniform_block = 0;
        int world_unit = 9;
        int material_unit = 10;  ///< of bindMaterials() only
    };

    virtual ~ShaderCollider() = default;

    /// Connects a program: samplers, block binding. Once after linking; leaves the program current.
    virtual void attach(GLuint program, const Binding& binding) const = 0;
    void attach(const GlProgram& program, const Binding& binding) const { attach(program.name(), binding); }
    /// Binds textures and block for the next draw.
    virtual void bind(const Binding& binding) const = 0;
    /// Binds the block's buffer as shader storage as well, for a compute shader (collider_tour.glsl). Needs hasCompute().
    virtual void bindStorage(int binding) const = 0;
    /// Lines for makeProgram (runtime/layout/collider_block.h).
    [[nodiscard]] virtual const std::string& defines() const = 0;
    [[nodiscard]] virtual int mapCount() const = 0;
    /// Of maps and materials on the GPU.
    [[nodiscard]] virtual std::size_t bytes() const = 0;

    /// The radius of the largest ball that a shader will query, so that a world finds the bodies that such a ball meets.
    virtual void reach(float /*radius*/) const {}
    /// 0 for one collider in its own space.
    [[nodiscard]] virtual std::size_t bodyCount() const { return 0; }
    /// Changes when a pose or a live body does.
    [[nodiscard]] virtual std::uint64_t revision() const { return 0; }

    /// The names of all materials, of which a shader has the numbers; equal names of several colliders are one. Empty without
    /// materials.
    [[nodiscard]] virtual std::span<const std::string> materialNames() const { return {}; }
    /// Some material has another restitution than 1, a friction or a loss of lifetime: without one only events need them.
    [[nodiscard]] virtual bool materialsRespond() const { return false; }
    /// Lines for makeProgram behind defines(), for a shader that includes the materials' file.
    [[nodiscard]] virtual std::string materialDefines() const { return {}; }
    /// Binds the texture of the materials, if there are any.
    virtual void bindMaterials(const Binding& /*binding*/) const {}

  protected:
    ShaderCollider() = default;
    ShaderCollider(ShaderCollider&&) = default;
    ShaderCollider& operator=(ShaderCollider&&) = default;
};

}  // namespace relief
