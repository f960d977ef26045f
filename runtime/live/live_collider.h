// SPDX-License-Identifier: Apache-2.0
// A deforming collider: a mesh with moving vertices. The GPU renders the mesh's depth maps before each step of the
// particles (Kolb, Latta and Rezk-Salama 2004, section 5). For each texel the GPU also stores the motion of the surface
// since the previous update, for the relative velocity at contacts.
//
//     LiveCollider live = *LiveCollider::create(positions, triangles, *liveMaps(box));
//     ColliderBody body{.collider = &live.frames(), .live = true};
//     WorldTextures textures = *WorldTextures::create({&body, 1});   // static bodies may be added
//     each step:  live.setPositions(…);  live.update(textures, 0);  particles.step(dt);
//
//     bytes on the GPU = those of GpuMesh and WorldTextures, and 44 · (maximum map width) · (maximum map height)
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

enum class LiveSize : std::uint8_t {
    kEqual,         ///< `resolution` texels along every side of the box
    kSquareTexels,  ///< `resolution` texels along the longest side of the box, in proportion along the others
};

/// Returns three axis-aligned front-back plane maps without texels, which enclose `box`.
/// \param box         object units; must contain the mesh at all times.
/// \param resolution  texels along a side, kMapSizeMin…kMapSizeMax.
/// Errors: kUsage (an empty or infinite box, a resolution out of range).
[[nodiscard]] Result<Collider> liveMaps(const Bounds& box, std::uint32_t resolution = 256,
                                        LiveSize size = LiveSize::kEqual);

class LiveCollider {
  public:
    /// Every call needs a current context, restores the GL state that it changes, and does not wait.
    /// \param positions, triangles  the initial mesh, as required by GpuMesh::create.
    /// \param frames  maps from liveMaps(). The box of a map must contain the mesh at all times: geometry outside is
    /// clipped, and maps with DepthMap::encloses classify all points outside the box as free space.
    /// Errors: those of GpuMesh and DepthMapRenderer; kUsage (maps that are not from liveMaps()).
    [[nodiscard]] static Result<LiveCollider> create(std::span<const glm::vec3> positions,
                                                     std::span<const glm::uvec3> triangles, Collider frames);

    /// Moves the vertices; update() renders them. Call it at most once between two updates, because update() records
    /// the motion of a single change.
    /// \param positions  object units, finite, as many as at creation.
    /// Errors: kUsage (called twice, a different count, a vertex outside a map with DepthMap::encloses), kInvalidInput
    /// (not finite). The state is then unchanged.
    [[nodiscard]] Result<void> setPositions(std::span<const glm::vec3> positions);
    /// Moves the vertices to positions in a GPU buffer: tightly packed triples of floats from byte `offset` on. The GPU
    /// copies them in command order; values are not checked. Errors: kUsage (called twice), those of
    /// GpuMesh::setPositions.
    [[nodiscard]] Result<void> setPositions(GLuint buffer, std::size_t offset = 0);
    /// Treats the last change as a jump: the next update() records no motion.
    void settle();

    /// Renders maps and motion into their textures. Call it before every step of the particles: the step assumes that
    /// the motion since the previous update took as long as the step. Costs nothing while the mesh is at rest.
    /// \param body  index in `textures` of the body that was created from frames() with ColliderBody::live.
    /// Errors: kUsage (a body that is not live or has other maps), kFailure.
    [[nodiscard]] Result<void> update(WorldTextures& textures, std::size_t body);

    /// Returns bounds, and maps without texels.
    [[nodiscard]] const Collider& frames() const { return frames_; }
    [[nodiscard]] const GpuMesh& mesh() const { return mesh_; }

  private:
    LiveCollider(GpuMesh mesh, DepthMapRenderer renderer, Collider frames)
        : mesh_(std::move(mesh)), renderer_(std::move(renderer)), frames_(std::move(frames)) {}
    [[nodiscard]] Result<void> rejectSecondChange() const;
    // These write to the attached textures of the slots.
    void copyTexels(const LiveSlot& slot, const DepthMap& map) const;
    void copyMotion(const LiveSlot& slot, const DepthMap& map) const;

    GpuMesh mesh_;
    DepthMapRenderer renderer_;  // used for one map after another
    Collider frames_;
    GlProgram motion_program_;
    GlFramebuffer texel_target_, motion_target_;
    bool shown_ = false;   // update() was called
    bool moved_ = false;   // since the last update
    bool moving_ = false;  // the rendered motion is not zero
};

}  // namespace relief
