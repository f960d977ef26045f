// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/mesh_buffers.h"

#include <cstddef>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

#include "runtime/gl/gl_functions.h"

namespace relief {
namespace {

struct Vertex {
    glm::vec3 position;
    glm::vec3 normal;
};

/// \param mesh  with normals.
std::vector<Vertex> verticesOf(const PictureMesh& mesh) {
    std::vector<Vertex> vertices(mesh.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i] = {mesh.positions[i], mesh.normals[i]};
    }
    return vertices;
}

}  // namespace

Result<MeshBuffers> MeshBuffers::create(const PictureMesh& mesh) {
    RELIEF_TRY(checkMesh(mesh));
    if (mesh.triangles.size() > static_cast<std::size_t>(std::numeric_limits<GLsizei>::max())) {
        return invalidInput("a mesh has too many triangles for one draw");
    }
    const PictureMesh made = mesh.normals.empty() ? withNormals(mesh) : PictureMesh{};
    const PictureMesh& full = mesh.normals.empty() ? made : mesh;
    const std::vector<Vertex> vertices = verticesOf(full);
    MeshBuffers out;
    out.corners_ = static_cast<GLsizei>(full.triangles.size());
    out.vertices_ = makeBuffer();
    out.colors_ = makeBuffer();
    out.vertex_bytes_ = static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex));
    out.triangles_ = makeBuffer();
    out.array_ = makeVertexArray();
    glBindVertexArray(out.array_.name());
    const auto attribute = [](GLuint location, GLint size, GLenum type, GLsizei stride, std::size_t offset) {
        glEnableVertexAttribArray(location);
        glVertexAttribPointer(location, size, type, type == GL_FLOAT ? GL_FALSE : GL_TRUE, stride,
                              reinterpret_cast<const void*>(offset));
    };
    glBindBuffer(GL_ARRAY_BUFFER, out.vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, out.vertex_bytes_, vertices.data(), GL_STATIC_DRAW);
    attribute(0, 3, GL_FLOAT, sizeof(Vertex), offsetof(Vertex, position));
    attribute(1, 3, GL_FLOAT, sizeof(Vertex), offsetof(Vertex, normal));
    glBindBuffer(GL_ARRAY_BUFFER, out.colors_.name());
    if (!full.colors.empty()) {
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(full.colors.size() * sizeof(full.colors[0])),
                     full.colors.data(), GL_STATIC_DRAW);
        attribute(2, 4, GL_UNSIGNED_BYTE, sizeof(full.colors[0]), 0);
    }
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, out.triangles_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(full.triangles.size() * sizeof(full.triangles[0])),
                 full.triangles.data(), GL_STATIC_DRAW);
    return out;
}

void MeshBuffers::setVertices(const PictureMesh& mesh) const {
    const std::vector<Vertex> vertices = verticesOf(mesh);
    glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    // Reallocate, so that this does not wait for previous draws.
    glBufferData(GL_ARRAY_BUFFER, vertex_bytes_, vertices.data(), GL_STREAM_DRAW);
}

void MeshBuffers::draw() const {
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, corners_, GL_UNSIGNED_INT, nullptr);
}

}  // namespace relief
