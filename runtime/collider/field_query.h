// Evaluates a collider at many points on the GPU, with the very shader code that the simulation runs:
// `relief query --gpu`, and the proof that shaders/collider/collider.glsl is formats/collider.cpp.
#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class FieldQuery {
  public:
    /// Needs a current context, of any GlApi; uploads the collider.
    /// Fails as ColliderTextures::create and makeProgram do.
    [[nodiscard]] static Result<FieldQuery> create(const Collider& collider);

    /// Uses textures that are there already: of one collider, or of bodies in their world, some of which may be
    /// live. They must outlive this. Fails as makeProgram does.
    [[nodiscard]] static Result<FieldQuery> create(const ColliderTextures& textures);

    /// One sample a point, in order. Waits for the GPU.
    /// Errors: kLimit (no room on the GPU), kUnsupported, kFailure.
    [[nodiscard]] Result<std::vector<FieldSample>> evaluate(std::span<const glm::vec3> points) const;

  private:
    FieldQuery() = default;

    std::unique_ptr<ColliderTextures> own_;  // null: the caller's
    const ColliderTextures* textures_ = nullptr;
    GlProgram program_;
};

}  // namespace relief
