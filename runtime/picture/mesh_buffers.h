// SPDX-License-Identifier: Apache-2.0
// A mesh of a picture in buffers of the GPU.
//
//     bytes on the GPU = 24 · vertices + 4 · corners, and 4 · vertices with colours
#pragma once

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {

class MeshBuffers {
  public:
    /// Needs a current context, and the state of a pass (PassState).
    /// \param mesh  without normals they are made, see withNormals.
    /// Errors: kInvalidInput (checkMesh, more triangles than one draw takes).
    [[nodiscard]] static Result<MeshBuffers> create(const PictureMesh& mesh);

    /// Moves the vertices: copies 24 bytes a vertex, position and normal as floats, from the beginning of a
    /// buffer of the GPU (wobble_pass.h). As many as the mesh was created with, which then has normals.
    void setVertices(const GlBuffer& buffer) const;

    /// The same from memory. \param mesh  with normals, of as many vertices.
    void setVertices(const PictureMesh& mesh) const;

    /// All triangles: attribute 0 is the position, 1 the normal, and 2 the colour of a mesh that has some.
    void draw() const;

  private:
    GlBuffer vertices_;
    GlBuffer colors_;
    GlBuffer triangles_;
    GlVertexArray array_;
    GLsizei corners_ = 0;
    GLsizeiptr vertex_bytes_ = 0;
};

}  // namespace relief
