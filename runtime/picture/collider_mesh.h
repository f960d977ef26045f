// SPDX-License-Identifier: Apache-2.0
// The source mesh of a collider on the GPU, for pictures with more detail than the depth maps contain.
#pragma once

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/mesh_buffers.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {

class ColliderMesh {
  public:
    /// Needs a current context; restores the GL state.
    /// \param mesh  in the collider's object space; missing normals are computed (withNormals()).
    /// Errors: kInvalidInput (checkMesh), kFailure (shader compiler).
    [[nodiscard]] static Result<ColliderMesh> create(const PictureMesh& mesh);

    /// Calls MeshBuffers::setVertices().
    void setVertices(const GlBuffer& buffer) { buffers_.setVertices(buffer); }

    /// Normals and depths per pixel.
    struct View {
        GlTexture normal;  ///< RGBA16F, object space, towards the viewer
        GlTexture depth;   ///< 32-bit window depth; 1 for the background
    };
    /// Draws the mesh. Restores the GL state.
    /// Errors: kUnsupported.
    [[nodiscard]] Result<View> view(const Camera& camera, GLsizei width, GLsizei height) const;

  private:
    MeshBuffers buffers_;
    GlProgram program_;
};

}  // namespace relief
