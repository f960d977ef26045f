// SPDX-License-Identifier: Apache-2.0
// Draws coloured meshes with sun and sky light, wetness and snow, for worlds whose field would take too long to trace.
// Shadows come from a depth map towards the sun. Exposure to rain and snow comes from a depth map towards the zenith.
// Ambient occlusion comes from the depths of the picture.
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
    glm::vec3 background{0.62F, 0.69F, 0.76F};  ///< sky at the horizon, and fog; sRGB
    glm::vec3 clay{0.74F, 0.60F, 0.52F};        ///< meshes without colours; sRGB
    float sun = 1.0F;                           ///< sunlight, 0 (overcast)…1
    float units_per_meter = 1.0F;  ///< world units per metre, > 0: scales grain, drifts and ambient occlusion
    float fog_distance = 0.0F;     ///< distance at which 63 % of the light is lost, world units; 0: no fog
    float wet = 0.0F;              ///< wetness of surfaces exposed to rain, 0…1
    float snow = 0.0F;             ///< snow cover of level surfaces exposed to the sky, 0…1
    friend bool operator==(const MeshStyle&, const MeshStyle&) = default;
};

/// An instance of a mesh.
struct MeshInstance {
    std::uint32_t mesh = 0;  ///< index of a mesh passed to create()
    Pose pose;
    /// Rain and snow pass through it, and it leaves footprints in snow. For characters.
    bool moves = false;
};

class MeshRenderer {
  public:
    /// Needs a current context, as all members do; restores the GL state.
    /// \param meshes  missing normals are computed (withNormals()).
    /// Errors: kInvalidInput (checkMesh), kFailure (shader compiler), kLimit (out of memory).
    [[nodiscard]] static Result<MeshRenderer> create(std::span<const PictureMesh> meshes);

    /// Replaces the positions of a mesh and recomputes its normals (MovingMesh).
    /// \param positions  one per vertex.
    /// Errors: kUsage (no such mesh, a different number of positions), kInvalidInput (a position that is not finite),
    /// kLimit (out of memory). On error, the mesh is unchanged.
    [[nodiscard]] Result<void> setPositions(std::size_t mesh, std::span<const glm::vec3> positions);
    /// Calls MeshBuffers::setVertices(). \param mesh  must have been created with normals.
    void setVertices(std::size_t mesh, const GlBuffer& buffer) { meshes_[mesh].buffers.setVertices(buffer); }

    /// Overwrites the target's colour and depth. Footprints persist between calls.
    /// \param around  region of shadows, exposure to rain and snow, and footprints; finite and not empty.
    /// Errors: kUnsupported, kLimit (target size, out of memory), kUsage (no such mesh).
    [[nodiscard]] Result<void> draw(const CameraMatrices& camera, const MeshStyle& style,
                                    std::span<const MeshInstance> places, const Bounds& around,
                                    const RenderTarget& target);

    /// Adds footprints of moving meshes without drawing, for the time between two pictures.
    /// \param units_per_meter  as in MeshStyle. \param around  as in draw(). Errors: kUsage (no such mesh).
    [[nodiscard]] Result<void> press(std::span<const MeshInstance> places, float units_per_meter,
                                     const Bounds& around);

    /// Returns the window depths of the last draw(): a texture as large as the target and not attached to it. Empty
    /// before the first draw().
    [[nodiscard]] const GlTexture& depth() const { return depth_; }

  private:
    struct Mesh {
        PictureMesh shape;
        MeshBuffers buffers;
        std::optional<MovingMesh> moving = {};  // after setPositions()
    };
    /// A depth map of the world along parallel rays.
    struct ParallelMap {
        GlTexture depth;
        GlFramebuffer framebuffer;
        glm::mat4 clip{1.0F};  // world space to clip space
    };

    [[nodiscard]] Result<void> resize(GLsizei width, GLsizei height);
    void drawPlaces(const GlProgram& program, std::span<const MeshInstance> places, bool still,
                    bool moving) const;
    void drawMap(const ParallelMap& map, std::span<const MeshInstance> places, bool moving) const;
    [[nodiscard]] Result<void> checkPlaces(std::span<const MeshInstance> places) const;
    /// Draws the map towards the zenith, without moving instances. Clears the footprints if `around` has changed.
    void drawZenith(std::span<const MeshInstance> places, const Bounds& around);
    void drawPrints(std::span<const MeshInstance> places, float units_per_meter);

    std::vector<Mesh> meshes_;
    GlProgram surface_program_;
    GlProgram depth_program_;
    GlProgram print_program_;
    GlProgram shade_program_;
    ParallelMap sun_;
    ParallelMap zenith_;
    GlTexture prints_;
    GlFramebuffer prints_target_;
    Bounds around_;  // region of the footprints
    GlTexture color_;
    GlTexture normal_;
    GlTexture depth_;
    GlFramebuffer surface_;
    GLsizei width_ = 0;
    GLsizei height_ = 0;
};

}  // namespace relief
