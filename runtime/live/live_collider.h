// SPDX-License-Identifier: Apache-2.0
// A collider that deforms: a mesh whose vertices move, and its depth maps, which the GPU renders anew before
// the particles move (Kolb, Latta and Rezk-Salama 2004, section 5). Beside each texel it keeps how far the
// surface there has gone since the update before: the velocity that a particle is met with.
//
//     LiveCollider live = *LiveCollider::create(positions, triangles, *liveFrames(box));
//     ColliderBody body{.collider = &live.frames(), .live = true};
//     WorldTextures textures = *WorldTextures::create({&body, 1});   // static bodies may stand beside
//     it each step:  live.setPositions(…);  live.update(textures, 0);  particles.step(dt);
//
//     bytes on the GPU = those of GpuMesh and of WorldTextures, and 44 a texel of a map
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "formats/base/result.h"
#include "formats/collider.h"
#include "runtime/bodies/world_textures.h"
#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/depth_maps/gpu_mesh.h"
#include "runtime/gl/gl_object.h"

namespace relief {

/// The sizes of live maps.
enum class LiveSize : std::uint8_t {
    kEqual,  ///< `resolution` texels along each side
    kSquareTexels,  ///< `resolution` texels along the longest side of the box, and as many in proportion along the others
};

/// Three front-back maps of planes along the axes, without texels, which enclose `box`.
/// \param box         object units: what the mesh never leaves, whatever it does.
/// \param resolution  texels along a side, kMapSizeMin…kMapSizeMax.
/// Errors: kUsage (an empty box or one that is not finite, a resolution out of range).
[[nodiscard]] Result<Collider> liveFrames(const Bounds& box, std::uint32_t resolution = 256,
                                          LiveSize size = LiveSize::kEqual);

class LiveCollider {
  public:
    /// Needs a current context, as every call does; every call restores the GL state that it touches, and
    /// none waits.
    /// \param positions, triangles  as GpuMesh::create wants them: the mesh before its first change.
    /// \param frames  maps as liveFrames() makes them. A map's box must hold the mesh at all times: what
    ///                leaves it is cut off, and a map that encloses everything then calls that free.
    /// Fails as GpuMesh and DepthMapRenderer do, and with kUsage (other maps).
    [[nodiscard]] static Result<LiveCollider> create(std::span<const glm::vec3> positions,
                                                     std::span<const glm::uvec3> triangles, Collider frames);

    /// Moves the vertices; update() shows it. Once between two updates, for the motion is that of one change.
    /// \param positions  object units, finite, as many as at first.
    /// Errors: kUsage (called twice; another number; a vertex outside of a map that encloses everything),
    /// kInvalidInput (not finite). Nothing then changes.
    [[nodiscard]] Result<void> setPositions(std::span<const glm::vec3> positions);
    /// The same from a buffer of the GPU: tightly packed triples of floats from `offset` bytes on; copied by
    /// the GPU in the order of commands. The numbers are not checked. Errors: kUsage (called twice;
    /// GpuMesh::setPositions).
    [[nodiscard]] Result<void> setPositions(GLuint buffer, std::size_t offset = 0);
    /// The last change was a jump, as if the vertices had always been there: the next update() has no motion.
    void settle();

    /// Renders the maps and the motion into their places. Call it before every step of the particles: each
    /// takes the motion since the update before as that of its own time. Costs nothing while the mesh rests.
    /// \param body  of `textures`, created from frames() with `live`.
    /// Errors: kUsage (a body that is not live or has other maps), kFailure.
    [[nodiscard]] Result<void> update(WorldTextures& textures, std::size_t body);

    /// Bounds, and maps without texels.
    [[nodiscard]] const Collider& frames() const { return frames_; }
    [[nodiscard]] const GpuMesh& mesh() const { return mesh_; }

  private:
    LiveCollider(GpuMesh mesh, DepthMapRenderer renderer, Collider frames)
        : mesh_(std::move(mesh)), renderer_(std::move(renderer)), frames_(std::move(frames)) {}
    [[nodiscard]] Result<void> refuseSecondChange() const;
    void copyTexels(const LiveSlot& slot, const DepthMap& map) const;
    void copyMotion(const LiveSlot& slot, const DepthMap& map) const;

    GpuMesh mesh_;
    DepthMapRenderer renderer_;  // of one map after another
    Collider frames_;
    GlProgram motion_program_;
    GlFramebuffer texel_target_, motion_target_;
    bool shown_ = false;   // by a first update
    bool moved_ = false;   // since the last update
    bool moving_ = false;  // the motion shown is not zero
};

}  // namespace relief
