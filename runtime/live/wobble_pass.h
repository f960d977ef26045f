// SPDX-License-Identifier: Apache-2.0
// Makes the vertices of a mesh wobble, on the GPU, by shaders/live/wobble.vert and transform feedback into a buffer:
// for LiveCollider::setPositions(buffer), and for the mesh's picture.
//
//     p + n · amplitude/3 · Σ_k sin(2π (p_k / wavelength − r_k frequency·t) + phase + k)
//     for k = 0, 1, 2 of x, y, z; r = (1, 1.25, 0.8); n the normal of the vertex
//
//     bytes on the GPU = 24 · vertices, and the buffers that are written: 12 or 24 a vertex
#pragma once

#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/live/vertex_feedback.h"

namespace relief {

/// A box that is larger than the mesh by the amplitude on every side holds the whole motion.
struct Wobble {
    float amplitude = 0.0F;   ///< object units
    float frequency = 1.0F;   ///< 1/s, ≥ 0
    float phase = 0.0F;       ///< radians
    float wavelength = 1.0F;  ///< object units, > 0
    friend bool operator==(const Wobble&, const Wobble&) = default;
};

/// The vertices at a time, by the formula above: CPU truth of WobblePass::run().
[[nodiscard]] std::vector<glm::vec3> wobbled(const Wobble& wobble, std::span<const glm::vec3> positions,
                                             std::span<const glm::vec3> normals, double time);

class WobblePass {
  public:
    /// Needs a current context, as run() does.
    /// \param positions  at rest, object units, finite; at least one.
    /// \param normals    as many, of length 1 or zero.
    /// Errors: kUsage (a number that is not finite or out of its range; no vertex, or not as many normals), kLimit (no
    /// room), kFailure (the driver's compiler).
    [[nodiscard]] static Result<WobblePass> create(const Wobble& wobble, std::span<const glm::vec3> positions,
                                                   std::span<const glm::vec3> normals,
                                                   VertexOutput output = VertexOutput::kPositions);

    /// Writes all vertices as they are at `time`, in seconds, into buffer(). Does not wait. Restores the GL
    /// state; no transform feedback of the caller's may be active.
    void run(double time);

    /// Of bytes(), rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return feedback_.buffer(); }
    [[nodiscard]] std::size_t bytes() const { return feedback_.bytes(); }

  private:
    Wobble wobble_;
    float inch_ = 0.0F;
    GlBuffer rest_;
    VertexFeedback feedback_;
};

}  // namespace relief
