// SPDX-License-Identifier: Apache-2.0
// Poses an animated mesh on the GPU, with shaders/live/skin.vert and transform feedback into a buffer, for
// LiveCollider::setPositions(buffer) and for rendering the mesh.
//
//     bytes on the GPU = 40 · vertices + 8 · influences + 16 · deltas + 96 · joints + 32 · weights,
//                        and the output buffer: 12 or 24 per vertex
#pragma once

#include <cstddef>
#include <glm/vec3.hpp>
#include <span>

#include "formats/animation/mesh_pose.h"
#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/live/vertex_feedback.h"

namespace relief {

class SkinPass {
  public:
    /// Needs a current context, as does run().
    /// \param mesh     valid.
    /// \param normals  one per vertex, of unit length or zero, in the space of the positions. If empty, run() only
    /// writes positions.
    /// Errors: kUsage (a different number of normals), kLimit (more than the textures of this context can hold),
    /// kFailure (shader compilation).
    [[nodiscard]] static Result<SkinPass> create(const AnimatedMesh& mesh,
                                                 std::span<const glm::vec3> normals = {});

    /// Writes all vertices of a pose into buffer(), in object space minus `origin`. Does not wait. Restores the GL
    /// state; the caller must not have transform feedback active.
    /// \param pose  has as many joints and weights as the mesh.
    void run(const MeshPose& pose, const glm::vec3& origin = glm::vec3(0.0F));

    /// Returns the output, in the layout kPositions or kPositionsAndNormals of VertexOutput. Rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return feedback_.buffer(); }
    [[nodiscard]] std::size_t bytes() const { return feedback_.bytes(); }

  private:
    VertexFeedback feedback_;
    GlBuffer rest_;
    GlBuffer upload_;
    GlTexture pose_;
    GlTexture influences_;
    GlTexture deltas_;
    glm::ivec3 shifts_{0};  // log2 of the widths of the three textures above
    int joints_ = 0;
    std::vector<glm::vec4> texels_;  // staging for pose_, kept to avoid reallocation
};

}  // namespace relief
