// SPDX-License-Identifier: Apache-2.0
// Animates the vertices of a mesh with a wobble on the GPU, with shaders/live/wobble.vert and transform feedback into a
// buffer, for LiveCollider::setPositions(buffer) and for rendering the mesh.
//
//     p + n · amplitude/3 · Σ_k sin(2π (p_k / wavelength − r_k frequency·t) + phase + k)
//     with k = 0, 1, 2 for x, y, z; p the vertex at rest, n its normal, t the time; r = (1, 1.25, 0.8)
//
//     bytes on the GPU = 24 · vertices, and the output buffer: 12 or 24 per vertex
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/live/vertex_feedback.h"

namespace relief {

/// Settings of the wobble. The mesh's box, enlarged by the amplitude on every side, contains the whole motion.
struct Wobble {
    float amplitude = 0.0F;   ///< object units
    float frequency = 1.0F;   ///< 1/s, ≥ 0
    float phase = 0.0F;       ///< radians
    float wavelength = 1.0F;  ///< object units, > 0
    friend bool operator==(const Wobble&, const Wobble&) = default;
};

/// Returns the vertices at `time`, in seconds, by the formula above. CPU reference of WobblePass::run().
[[nodiscard]] std::vector<glm::vec3> wobbled(const Wobble& wobble, std::span<const glm::vec3> positions,
                                             std::span<const glm::vec3> normals, double time);

class WobblePass {
  public:
    /// Needs a current context, as does run().
    /// \param positions  at rest, object units, finite; at least one.
    /// \param normals    as many as positions, of unit length or zero.
    /// Errors: kUsage (a number that is not finite or out of range, no vertices, a different number of normals), kLimit
    /// (out of memory), kFailure (shader compilation).
    [[nodiscard]] static Result<WobblePass> create(const Wobble& wobble, std::span<const glm::vec3> positions,
                                                   std::span<const glm::vec3> normals,
                                                   VertexOutput output = VertexOutput::kPositions);

    /// Writes all vertices at `time`, in seconds, into buffer(). Does not wait. Restores the GL state; the caller must
    /// not have transform feedback active.
    void run(double time);

    /// Returns the output, bytes() in size and rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return feedback_.buffer(); }
    [[nodiscard]] std::size_t bytes() const { return feedback_.bytes(); }

  private:
    Wobble wobble_;
    float step_ = 0.0F;  // step of the finite differences for normals, object units
    GlBuffer rest_;
    VertexFeedback feedback_;
};

}  // namespace relief
