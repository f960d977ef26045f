// SPDX-License-Identifier: Apache-2.0
// Poses an animated mesh on the GPU, by shaders/live/skin.vert and transform feedback into a buffer: for
// LiveCollider::setPositions(buffer), and for the mesh's picture.
//
//     bytes on the GPU = 40 · vertices + 8 · influences + 16 · deltas + 96 · joints + 32 · targets,
//                        and the buffer that is written: 12 or 24 a vertex
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
    /// Needs a current context, as run() does.
    /// \param mesh     valid.
    /// \param normals  one a vertex, of length 1 or zero, in the space of the positions; or none: then run() writes positions
    ///                 alone.
    /// Errors: kUsage (another number of normals), kLimit (more than this GL's textures hold), kFailure (the driver's compiler).
    [[nodiscard]] static Result<SkinPass> create(const AnimatedMesh& mesh,
                                                 std::span<const glm::vec3> normals = {});

    /// Writes all vertices of that pose, object space less `origin`, into buffer(). Does not wait. Restores the GL state; no
    /// transform feedback of the caller's may be active.
    /// \param pose  of as many joints and weights as the mesh has.
    void run(const MeshPose& pose, const glm::vec3& origin = glm::vec3(0.0F));

    /// Of VertexOutput::kPositions, or of kPositionsAndNormals. Rewritten by every run().
    [[nodiscard]] const GlBuffer& buffer() const { return feedback_.buffer(); }
    [[nodiscard]] std::size_t bytes() const { return feedback_.bytes(); }

  private:
    VertexFeedback feedback_;
    GlBuffer rest_;
    GlBuffer upload_;
    GlTexture pose_;
    GlTexture influences_;
    GlTexture deltas_;
    glm::ivec3 shifts_{0};  // of these three
    int joints_ = 0;
    std::vector<glm::vec4> texels_;  // of pose_, kept for their memory
};

}  // namespace relief
