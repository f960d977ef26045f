// Deforms the vertices of a mesh on the GPU, by shaders/collider/deform.vert and transform feedback, into a buffer:
// for LiveCollider::setPositions(buffer), and for the mesh's picture.
//
//     bytes on the GPU = 24 · vertices, and the buffers that are written: 12 or 24 a vertex
#pragma once

#include <glm/vec3.hpp>
#include <span>

#include "formats/base/result.h"
#include "runtime/collider/deformation.h"
#include "runtime/collider/pose.h"
#include "runtime/gl/gl_object.h"

namespace relief {

class DeformPass {
  public:
    /// The output of a vertex.
    enum class Output : std::uint8_t {
        kPositions,           ///< three floats, tightly packed
        kPositionsAndNormals  ///< six: position and normal, as ColliderMesh's vertices
    };

    /// Needs a current context, as run() does.
    /// \param positions  at rest, object units, finite; at least one.
    /// \param normals    as many, of length 1 or zero; or none where neither a wobble nor kPositionsAndNormals
    ///                   needs them.
    /// Errors: kUsage (checkDeformation; normals that are missing; no vertex), kFailure (the driver's
    /// compiler).
    [[nodiscard]] static Result<DeformPass> create(const Deformation& deformation,
                                                   std::span<const glm::vec3> positions,
                                                   std::span<const glm::vec3> normals,
                                                   Output output = Output::kPositions);

    /// Writes all vertices as they are at `time`, in seconds, into buffer(). Does not wait. Restores the GL
    /// state; no transform feedback of the caller's may be active.
    /// \param pose  comes after the deformation.
    void run(double time, const Pose& pose = {});

    /// Of bytes(), rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return output_; }
    [[nodiscard]] std::size_t bytes() const;

  private:
    Deformation deformation_;
    Output what_ = Output::kPositions;
    GLsizei vertices_ = 0;
    float inch_ = 0.0F;
    GlBuffer rest_;
    GlBuffer output_;
    GlVertexArray array_;
    GlTexture pixel_;  // a draw needs a whole framebuffer, even one that rasterises nothing
    GlFramebuffer target_;
    GlProgram program_;
};

}  // namespace relief
