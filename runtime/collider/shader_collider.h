// SPDX-License-Identifier: Apache-2.0
// The inputs of shaders that include collider/collider.glsl: a collider in its own object space (ColliderTextures) or a
// world of bodies (runtime/bodies).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "runtime/gl/gl_object.h"

namespace relief {

class ShaderCollider {
  public:
    /// Texture units and uniform block binding used by bind(): `first_unit` and the next two; worlds also use
    /// `world_unit`.
    struct Binding {
        int first_unit = 0;
        int uniform_block = 0;
        int world_unit = 9;
        int material_unit = 10;  ///< used only by bindMaterials()
    };

    virtual ~ShaderCollider() = default;

    /// Connects a program: samplers and block binding. Call it once after linking; it leaves the program current.
    virtual void attach(GLuint program, const Binding& binding) const = 0;
    void attach(const GlProgram& program, const Binding& binding) const { attach(program.name(), binding); }
    /// Binds textures and block for the next draw.
    virtual void bind(const Binding& binding) const = 0;
    /// Also binds the block's buffer as shader storage, for compute shaders (collider_tour.glsl). Requires
    /// hasCompute().
    virtual void bindStorage(int binding) const = 0;
    /// Returns lines for makeProgram (runtime/layout/collider_block.h).
    [[nodiscard]] virtual const std::string& defines() const = 0;
    [[nodiscard]] virtual int mapCount() const = 0;
    /// Returns the bytes of maps and materials on the GPU.
    [[nodiscard]] virtual std::size_t bytes() const = 0;

    /// Raises the maximum radius of the balls that shaders will query, so that the broad phase of a world finds all
    /// bodies that such a ball touches. Smaller radii have no effect.
    virtual void reach(float /*radius*/) const {}
    /// Returns the number of bodies; 0 for a single collider in its own space.
    [[nodiscard]] virtual std::size_t bodyCount() const { return 0; }
    /// Returns a number that changes with every change of a pose, a map or a live body.
    [[nodiscard]] virtual std::uint64_t revision() const { return 0; }

    /// Returns the names of all materials, indexed by the numbers that shaders use. Equal names in several colliders
    /// share a number. Empty without materials.
    [[nodiscard]] virtual std::span<const std::string> materialNames() const { return {}; }
    /// Returns whether a material has a restitution other than 1, or a nonzero friction or lifetime loss. If false,
    /// only events need materials.
    [[nodiscard]] virtual bool materialsAffectReaction() const { return false; }
    /// Returns lines for makeProgram, after defines(), for shaders that include bodies/materials.glsl.
    [[nodiscard]] virtual std::string materialDefines() const { return {}; }
    /// Binds the texture of the materials, if there is one.
    virtual void bindMaterials(const Binding& /*binding*/) const {}

  protected:
    ShaderCollider() = default;
    ShaderCollider(ShaderCollider&&) = default;
    ShaderCollider& operator=(ShaderCollider&&) = default;
};

}  // namespace relief
