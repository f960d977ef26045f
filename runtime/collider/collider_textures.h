// SPDX-License-Identifier: Apache-2.0
// One collider on the GPU, in its own object space. runtime/bodies adds materials, and worlds of bodies.
//
//     const Collider bunny = *readContainer(bytes);
//     ColliderTextures textures = *ColliderTextures::create(bunny);
//     particles.setCollider(&textures);
#pragma once

#include <cstddef>
#include <string>
#include <utility>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/collider/map_textures.h"
#include "runtime/collider/shader_collider.h"

namespace relief {

class ColliderTextures : public ShaderCollider {
  public:
    /// Uploads a collider without its materials. Needs a current context.
    /// Errors: kLimit (more texels or maps than this GL context supports; the message contains both numbers),
    /// kUnsupported (no maps).
    [[nodiscard]] static Result<ColliderTextures> create(const Collider& collider);

    using ShaderCollider::attach;
    void attach(GLuint program, const Binding& binding) const override { maps_.attach(program, binding); }
    void bind(const Binding& binding) const override { maps_.bind(binding); }
    void bindStorage(int binding) const override { maps_.bindStorage(binding); }
    [[nodiscard]] const std::string& defines() const override { return defines_; }
    [[nodiscard]] int mapCount() const override { return maps_.count(); }
    [[nodiscard]] std::size_t bytes() const override { return maps_.bytes(); }

    /// Moves the maps out, for WorldTextures.
    [[nodiscard]] MapTextures takeMaps() && { return std::move(maps_); }

  private:
    MapTextures maps_;
    std::string defines_;
};

}  // namespace relief
