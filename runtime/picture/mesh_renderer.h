// SPDX-License-Identifier: Apache-2.0
// Draws meshes in their colours, under a sun and a sky, wet or snowed on: the picture of a world, whose field would take too
// long to follow rays through. Shadows come from a depth map towards the sun, what rain and snow reach from one towards the
// zenith, and the shade of corners from the picture's own depths.
//
//     bytes on the GPU = 28 · vertices + 4 · corners + 16 · width · height + 144 MiB
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "formats/world/pose.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/mesh_buffers.h"
#include "runtime/picture/picture_mesh.h"
#include "runtime/picture/render_target.h"

namespace relief {

struct MeshStyle {
    glm::vec3 background{0.62F, 0.69F, 0.76F};  ///< of the sky at the horizon, and of the fog; sRGB
    glm::vec3 clay{0.74F, 0.60F, 0.52F};        ///< of meshes without colours; sRGB
    float sun = 1.0F;                           ///< light of the sun, 0 (overcast)…1
    float metre = 1.0F;  ///< world units of a metre, > 0: of grain, drifts, and the shade of corners
    float fog = 0.0F;    ///< world units over which 63 % of the light is lost; 0: none
    float wet = 0.0F;    ///< of what rain reaches, 0…1
    float snow = 0.0F;   ///< cover of what snow reaches, 0…1
    friend bool operator==(const MeshStyle&, const MeshStyle&) = default;
};

/// One mesh in the picture.
struct MeshPlace {
    std::uint32_t mesh = 0;  ///< of create()'s
    Pose pose;
    /// Rain and snow fall through it, and it presses its outline into the snow: that of a figure's feet.
    bool moves = false;
};

class MeshRenderer {
  public:
    /// Needs a current context, as all others here do; restores what it touches.
    /// \param meshes  those without normals get them (withNormals()).
    /// Errors: kInvalidInput (checkMesh), kFailure (the driver's compiler), kLimit (no room).
    [[nodiscard]] static Result<MeshRenderer> create(std::span<const PictureMesh> meshes);

    /// Other vertices for a mesh, of as many positions; its normals are made anew (MovingMesh).
    /// Errors: kUsage (no such mesh, another number), kInvalidInput (a position that is not finite), kLimit (no room); the mesh
    /// then stays as it was.
    [[nodiscard]] Result<void> setPositions(std::size_t mesh, std::span<const glm::vec3> positions);
    /// As MeshBuffers::setVertices(). \param mesh  created with normals.
    void setVertices(std::size_t mesh, const GlBuffer& buffer);

    /// Fills the target's colour and depth. Prints stay from one call to the next.
    /// \param around  the part of the world that has shadows, shelter and prints; finite, with an extent.
    /// Errors: kUnsupported, kLimit (the target's size, no room), kUsage (no such mesh).
    [[nodiscard]] Result<void> draw(const CameraMatrices& camera, const MeshStyle& style,
                                    std::span<const MeshPlace> places, const Bounds& around,
                                    const RenderTarget& target);

    /// Prints of what moves, without a picture: for the time between two of them.
    /// \param metre  as in MeshStyle. \param around  as in draw(). Errors: kUsage (no such mesh).
    [[nodiscard]] Result<void> press(std::span<const MeshPlace> places, float metre, const Bounds& around);

    /// The window depth of what draw() drew last, of that target's size and not attached to it; empty before.
    [[nodiscard]] const GlTexture& depth() const { return depth_; }

  private:
    struct Mesh {
        PictureMesh shape;
        MeshBuffers buffers;
        std::optional<MovingMesh> moving = {};  // once it has moved
    };
    /// A depth map of the world along parallel rays.
    struct ParallelMap {
        GlTexture depth;
        GlFramebuffer framebuffer;
        glm::mat4 clip{1.0F};  // world to its clip space
    };

    [[nodiscard]] Result<void> resize(GLsizei width, GLsizei height);
    void drawPlaces(const GlProgram& program, std::span<const MeshPlace> places, bool still,
                    bool moving) const;
    void drawMap(const ParallelMap& map, std::span<const MeshPlace> places, bool moving) const;
    [[nodiscard]] Result<void> checkPlaces(std::span<const MeshPlace> places) const;
    /// The map of the still things from above; around another part of the world it clears the prints.
    void drawZenith(std::span<const MeshPlace> places, const Bounds& around);
    void drawPrints(std::span<const MeshPlace> places, float metre);

    std::vector<Mesh> meshes_;
    GlProgram surface_program_;
    GlProgram depth_program_;
    GlProgram print_program_;
    GlProgram shade_program_;
    ParallelMap sun_;
    ParallelMap zenith_;
    GlTexture prints_;
    GlFramebuffer prints_target_;
    Bounds around_;  // of the prints
    GlTexture color_;
    GlTexture normal_;
    GlTexture depth_;
    GlFramebuffer surface_;
    GLsizei width_ = 0;
    GLsizei height_ = 0;
};

}  // namespace relief
