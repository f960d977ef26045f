// SPDX-License-Identifier: Apache-2.0
// GPU buffers of a PictureMesh.
//
//     bytes on the GPU = 24 · vertices + 4 · corners, plus 4 · vertices if the mesh has colours
#pragma once

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/picture/picture_mesh.h"

namespace relief {

class MeshBuffers {
  public:
    /// Needs a current context and the state of a pass (PassState).
    /// \param mesh  missing normals are computed (withNormals()).
    /// Errors: kInvalidInput (checkMesh, too many triangles for one draw).
    [[nodiscard]] static Result<MeshBuffers> create(const PictureMesh& mesh);

    /// Replaces all vertices with the vertices in a GPU buffer (wobble_pass.h): 24 bytes each, position and normal as
    /// floats. Requires that the mesh passed to create() has normals.
    void setVertices(const GlBuffer& buffer) const { copyBuffer(buffer, vertices_, 0, vertex_bytes_); }

    /// Replaces all vertices. \param mesh  with normals and the same number of vertices.
    void setVertices(const PictureMesh& mesh) const;

    /// Draws all triangles. Attributes: 0 position, 1 normal, 2 colour (if the mesh has colours).
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
