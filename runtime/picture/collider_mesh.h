// The mesh that a collider was baked from, on the GPU, for the collider's picture: it has the detail that depth maps
// leave out.
//
//     bytes on the GPU = 24 · vertices + 12 · triangles
#pragma once

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {

class ColliderMesh {
  public:
    /// Needs a current context; restores what it touches.
    /// \param mesh  in the collider's object space; without normals they are made, see withNormals.
    /// Errors: kInvalidInput (checkMesh), kFailure (the driver's compiler).
    [[nodiscard]] static Result<ColliderMesh> create(const PictureMesh& mesh);

    /// Moves the vertices: copies 24 bytes a vertex, position and normal as floats, from the beginning of a
    /// buffer of the GPU (wobble_pass.h). As many as the mesh was created with, which then has normals.
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
    GlBuffer vertices_;
    GlBuffer triangles_;
    GlVertexArray array_;
    GlProgram program_;
    GLsizei corners_ = 0;
    GLsizeiptr vertex_bytes_ = 0;
};

}  // namespace relief
