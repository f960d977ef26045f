// SPDX-License-Identifier: Apache-2.0
// A triangle mesh on the GPU with fixed triangles and movable vertices, from which depth maps are rendered
// (depth_map_renderer.h).
//
// Positions are stored in a 2-D float texture so that shaders can fetch the corners of any triangle. Triangles are
// drawn with an index buffer over *slots*: slot t < triangleCount() is the last, provoking corner of triangle t and of
// no other triangle, so that a flat varying of gl_VertexID identifies the triangle (fragment shaders of OpenGL ES 3.0
// have no gl_PrimitiveID). Vertices without such a slot get one after these slots.
//
//                       b                 slots of t:  a (t's own, provoking), b and c (owned by other
//                      /t\                             triangles if possible)
//                     a---c               slots < triangles + vertices; usually as many as triangles
//
//     bytes on the GPU = 24 · vertices (32 if the driver pads RGB32F) + 4 · slots + 44 · triangles
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
    /// Needs a current context, as do all calls; restores the GL state that it changes.
    /// \param positions  finite, object space, at least one.
    /// \param triangles  at least one; counter-clockwise seen from outside.
    /// Errors: kInvalidInput (an index out of range, a position that is not finite, no triangles), kLimit (more than
    /// this GL context's textures or indices support, or out of memory), kUnsupported, kFailure (shader compilation).
    [[nodiscard]] static Result<GpuMesh> create(std::span<const glm::vec3> positions,
                                                std::span<const glm::uvec3> triangles);

    /// Moves the vertices.
    /// \param positions  finite, as many as at creation.
    /// Errors: kUsage (a different count), kInvalidInput (not finite); the mesh is then unchanged.
    [[nodiscard]] Result<void> setPositions(std::span<const glm::vec3> positions);
    /// Moves the vertices to positions in a GPU buffer: tightly packed triples of floats from byte `offset` on. The GPU
    /// copies them in command order, without waiting. Values are not checked: a triangle with a corner that is not
    /// finite may be missing or drawn anywhere.
    /// Errors: kUsage (no such buffer, an offset that is not a multiple of 4, a buffer that is too short).
    [[nodiscard]] Result<void> setPositions(GLuint buffer, std::size_t offset = 0);
    /// Resets the motion to zero. Call it after a jump, or when the vertices have come to rest.
    void settle();

    [[nodiscard]] std::uint32_t triangleCount() const { return triangle_count_; }
    [[nodiscard]] std::uint32_t slotCount() const { return slot_count_; }
    /// Returns a number that changes with every change of the positions.
    [[nodiscard]] std::uint64_t revision() const { return revision_; }

    // Inputs of passes. Item i lies at (i & ((1 << shift) − 1), i >> shift).

    /// RGB32F: xyz of vertex i.
    [[nodiscard]] GLuint positions() const { return positions_[current_].name(); }
    /// The positions before the last setPositions(), for the motion of the surface.
    [[nodiscard]] GLuint previousPositions() const;
    [[nodiscard]] int vertexShift() const { return vertex_shift_; }
    /// RGBA32UI: the vertices of triangle i, its provoking corner last; w is 0.
    [[nodiscard]] GLuint corners() const { return corners_.name(); }
    /// RGBA32UI for each triangle: xyz, its right-handed unit normal as float bits (0 if it has no area); w, the packed
    /// index of the normal (normal_index.h) plus 65536 times the index of the opposite normal. Updated with one draw if
    /// the positions have changed since the last call. Call it inside a PassState because it changes GL state.
    [[nodiscard]] GLuint planes();
    [[nodiscard]] int triangleShift() const { return triangle_shift_; }
    /// Draws all triangles with the current program; attribute 0 is the slot's vertex, an unsigned integer. Binds a
    /// vertex array.
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
