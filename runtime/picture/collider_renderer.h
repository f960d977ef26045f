// SPDX-License-Identifier: Apache-2.0
// Draws a collider on a floor in front of a background: its mesh if given, otherwise its depth maps. Tracing the field
// is expensive, so the picture is cached in a texture until the collider, camera, size or style changes.
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
    /// \param mesh  the source mesh of the collider; must outlive this. Null: draw the depth maps.
    /// Errors: kFailure (shader compiler).
    [[nodiscard]] static Result<ColliderRenderer> create(const ColliderView& view,
                                                         const ColliderMesh* mesh = nullptr);

    /// Overwrites the colour (linear or sRGB, as the target requires) and the depth of the target.
    /// Errors: kUnsupported, kLimit (target size, out of memory), kFailure.
    [[nodiscard]] Result<void> draw(const Camera& camera, const ColliderStyle& style,
                                    const RenderTarget& target);

    /// Returns the window depths of the last draw(): a texture as large as the target and not attached to it. Empty
    /// before the first draw().
    [[nodiscard]] const GlTexture& depth() const { return depth_; }

  private:
    [[nodiscard]] Result<void> trace(const Camera& camera, const ColliderStyle& style, GLsizei width,
                                     GLsizei height);
    /// Creates `coarse` and traces every fourth ray of every fourth row.
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
    std::optional<Drawn> drawn_;  // contents of the textures below
    GlTexture color_;
    GlTexture depth_;
};

}  // namespace relief
