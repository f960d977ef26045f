// SPDX-License-Identifier: Apache-2.0
// A triangle mesh on the GPU whose triangles stay and whose vertices may move: what depth maps are rendered
// from (depth_map_renderer.h).
//
// Positions lie in a 2-D texture of floats, so that a shader finds the corners of any triangle. Triangles are
// drawn with an index buffer over *slots*: slot t < triangleCount() belongs to triangle t alone and is its
// last, provoking corner, so that gl_VertexID of a flat varying names the triangle (a fragment shader of
// OpenGL ES 3.0 has no gl_PrimitiveID). Vertices that own no slot so far have one behind those.
//
//                       b                 slots of t:  a (t's own, provoking), b and c (owned by other
//                      /t\                             triangles, wherever possible)
//                     a---c               slots < triangles + vertices, and mostly as many as triangles
//
//     bytes on the GPU = 24 or 32 · vertices + 4 · slots + 44 · triangles
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class GpuMesh {
  public:
    /// Needs a current context, as every call does; restores what it touches.
    /// \param positions  finite, object space, at least one.
    /// \param triangles  at least one; anticlockwise seen from outside.
    /// Errors: kInvalidInput (an index beyond the positions, a position that is not finite, no triangle),
    /// kLimit (more than this GL's textures or indices hold, no room), kUnsupported, kFailure (the driver's compiler).
    [[nodiscard]] static Result<GpuMesh> create(std::span<const glm::vec3> positions,
                                                std::span<const glm::uvec3> triangles);

    /// Moves the vertices.
    /// \param positions  finite, as many as at first.
    /// Errors: kUsage (another number), kInvalidInput (not finite); the mesh then stays as it was.
    [[nodiscard]] Result<void> setPositions(std::span<const glm::vec3> positions);
    /// The same from a buffer of the GPU: tightly packed triples of floats from `offset` bytes on, a multiple
    /// of 4. Copied by the GPU in the order of commands; nothing waits, and finiteness is not checked:
    /// a triangle with a corner that is not is not drawn, or anywhere. Errors: kUsage (0, no buffer, an
    /// offset that is no multiple of 4, a buffer that is too short).
    [[nodiscard]] Result<void> setPositions(GLuint buffer, std::size_t offset = 0);
    /// Forgets the motion, as if the vertices had always been where they are (after a jump, or when they have come to rest).
    void settle();

    [[nodiscard]] std::uint32_t triangleCount() const { return triangle_count_; }
    [[nodiscard]] std::uint32_t slotCount() const { return slot_count_; }
    /// Changes with every change of the positions.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }

    // For passes. Item i lies at (i & ((1 << shift) − 1), i >> shift).

    /// RGB32F, or RGBA32F where the GL does not copy triples: xyz of vertex i.
    [[nodiscard]] GLuint positions() const { return positions_[current_].name(); }
    /// Those of before the last setPositions(), for the motion of the surface.
    [[nodiscard]] GLuint previousPositions() const;
    [[nodiscard]] int vertexShift() const { return vertex_shift_; }
    /// RGBA32UI: the vertices of triangle i, its own corner last; w is 0.
    [[nodiscard]] GLuint corners() const { return corners_.name(); }
    /// RGBA32UI: of triangle i the unit normal's bits as floats by the right-hand rule (0: no area), and in w
    /// its packed index (normal_index.h) plus 65536 times that of the opposite normal. Made anew, by one
    /// draw, if the positions have changed since the last call, which leaves GL state changed: call it inside
    /// a PassState.
    [[nodiscard]] GLuint planes();
    [[nodiscard]] int triangleShift() const { return triangle_shift_; }
    /// Draws all triangles with the current program; attribute 0 is the slot's vertex, an unsigned integer.
    /// Binds a vertex array.
    void draw() const;

  private:
    [[nodiscard]] Result<void> createTextures(std::span<const glm::uvec3> triangles);
    void upload(const void* data);

    std::uint32_t vertex_count_ = 0;
    std::uint32_t triangle_count_ = 0;
    std::uint32_t slot_count_ = 0;
    int vertex_shift_ = 0;
    int triangle_shift_ = 0;
    std::uint64_t revision_ = 0;
    std::uint64_t planes_revision_ = 0;
    GlTexture positions_[2];
    int current_ = 0;
    bool moved_ = false;
    GlTexture corners_;
    GlTexture planes_;
    GlFramebuffer planes_target_;
    GlProgram planes_program_;
    GlBuffer slots_;
    GlBuffer indices_;
    GlVertexArray array_;
};

}  // namespace relief
