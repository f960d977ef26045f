// SPDX-License-Identifier: Apache-2.0
// The mesh that a collider was baked from, on the GPU, for the collider's picture: it has the detail that depth maps
// leave out.
#pragma once

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/mesh_buffers.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {

class ColliderMesh {
  public:
    /// Needs a current context; restores what it touches.
    /// \param mesh  in the collider's object space; without normals they are made, see withNormals.
    /// Errors: kInvalidInput (checkMesh), kFailure (the driver's compiler).
    [[nodiscard]] static Result<ColliderMesh> create(const PictureMesh& mesh);

    /// As MeshBuffers::setVertices().
    void setVertices(const GlBuffer& buffer);

    /// A camera's view of it, pixel by pixel.
    struct View {
        GlTexture normal;  ///< RGBA16F, object space, towards the viewer
        GlTexture depth;   ///< 32-bit window depth; 1 where there is nothing
    };
    /// Restores the GL state.
    /// Errors: kUnsupported.
    [[nodiscard]] Result<View> view(const Camera& camera, GLsizei width, GLsizei height) const;

  private:
    MeshBuffers buffers_;
    GlProgram program_;
};

}  // namespace relief
