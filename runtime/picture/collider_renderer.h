// SPDX-License-Identifier: Apache-2.0
// Draws a collider on a floor before a background: from its mesh, or from its own depth maps if there is
// none. Rays through the combined field cost much and collider and camera mostly stand still, so the picture
// is kept and drawn again from a texture until camera, size or style change.
//
//     bytes on the GPU = 12 · width · height   (RGBA16F and 32-bit depth)
#pragma once

#include <optional>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/collider_mesh.h"
#include "runtime/picture/collider_view.h"
#include "runtime/picture/render_target.h"

namespace relief {

struct ColliderStyle {
    std::optional<float> ground;                ///< height of the floor, object units; nullopt: none
    glm::vec3 background{0.62F, 0.69F, 0.76F};  ///< sRGB
    glm::vec3 clay{0.74F, 0.60F, 0.52F};        ///< sRGB
    friend bool operator==(const ColliderStyle&, const ColliderStyle&) = default;
};

class ColliderRenderer {
  public:
    /// Needs a current context, as draw() does.
    /// \param mesh  what the collider was baked from; it must outlive this. Null: the depth maps are drawn.
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] static Result<ColliderRenderer> create(const ColliderView& view,
                                                         const ColliderMesh* mesh = nullptr);

    /// Fills the target's colour, in linear light or sRGB as the target has it, and its depth.
    /// Errors: kUnsupported, kLimit (the target's size, no room), kFailure.
    [[nodiscard]] Result<void> draw(const Camera& camera, const ColliderStyle& style,
                                    const RenderTarget& target);

    /// The window depth of what draw() drew last, of that target's size and not attached to it; empty before.
    [[nodiscard]] const GlTexture& depth() const { return depth_; }

  private:
    [[nodiscard]] Result<void> trace(const Camera& camera, const ColliderStyle& style, GLsizei width,
                                     GLsizei height);
    /// Follows every fourth ray of every fourth row into `coarse`, which it makes.
    [[nodiscard]] Result<void> traceCoarse(GLsizei width, GLsizei height, GlTexture& coarse);

    struct Drawn {
        Camera camera;
        ColliderStyle style;
        GLsizei width = 0;
        GLsizei height = 0;
        std::uint64_t revision = 0;  // ShaderCollider::revision()
        friend bool operator==(const Drawn&, const Drawn&) = default;
    };

    ColliderView view_;
    const ColliderMesh* mesh_ = nullptr;
    GlProgram coarse_program_;
    GlProgram trace_program_;
    GlProgram copy_program_;
    std::optional<Drawn> drawn_;  // what the textures below show
    GlTexture color_;
    GlTexture depth_;
};

}  // namespace relief
