// Draws a collider from its own depth maps, on a floor before a background: no mesh is needed. Rays through
// the combined field cost much and collider and camera stand still, so the picture is kept and drawn again
// from a texture until camera, size or style change.
//
//     bytes on the GPU = 12 · width · height   (RGBA16F and 32-bit depth)
#pragma once

#include <optional>

#include "formats/result.h"
#include "runtime/camera.h"
#include "runtime/collider_view.h"
#include "runtime/gl_object.h"
#include "runtime/render_target.h"

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
    /// Errors: kFailure (the driver's compiler).
    [[nodiscard]] static Result<ColliderRenderer> create(const ColliderView& view);

    /// Fills the target's colour, in linear light, and its depth.
    /// Errors: kUnsupported, kLimit (the target's size).
    [[nodiscard]] Result<void> draw(const Camera& camera, const ColliderStyle& style,
                                    const RenderTarget& target);

  private:
    [[nodiscard]] Result<void> trace(const Camera& camera, const ColliderStyle& style, GLsizei width,
                                     GLsizei height);

    struct Drawn {
        Camera camera;
        ColliderStyle style;
        GLsizei width = 0;
        GLsizei height = 0;
        friend bool operator==(const Drawn&, const Drawn&) = default;
    };

    ColliderView view_;
    GlProgram coarse_program_;
    GlProgram trace_program_;
    GlProgram copy_program_;
    GlVertexArray no_attributes_;
    std::optional<Drawn> drawn_;  // what the textures below show
    GlTexture color_;
    GlTexture depth_;
};

}  // namespace relief
