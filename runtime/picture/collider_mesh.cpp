#include "runtime/picture/collider_mesh.h"

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

struct Vertex {
    glm::vec3 position;
    glm::vec3 normal;
};

void setAttribute(GLuint location, std::size_t offset) {
    glEnableVertexAttribArray(location);
    glVertexAttribPointer(location, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                          reinterpret_cast<const void*>(offset));
}

}  // namespace

Result<ColliderMesh> ColliderMesh::create(const PictureMesh& mesh) {
    RELIEF_TRY(checkContext());
    RELIEF_TRY(checkMesh(mesh));
    if (mesh.triangles.size() > static_cast<std::size_t>(std::numeric_limits<GLsizei>::max())) {
        return fail(ErrorCode::kInvalidInput, "a mesh of more triangles than one draw takes");
    }
    const PictureMesh made = mesh.normals.empty() ? withNormals(mesh) : PictureMesh{};
    const PictureMesh& full = mesh.normals.empty() ? made : mesh;
    std::vector<Vertex> vertices(full.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        vertices[i] = {full.positions[i], full.normals[i]};
    }
    const PassState state;
    forgetGlErrors();
    ColliderMesh out;
    out.program_ = RELIEF_TRY(makeProgram("picture/mesh.vert", "picture/mesh.frag"));
    out.vertex_bytes_ = static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex));
    out.corners_ = static_cast<GLsizei>(full.triangles.size());
    out.vertices_ = makeBuffer();
    out.triangles_ = makeBuffer();
    out.array_ = makeVertexArray();
    glBindVertexArray(out.array_.name());
    glBindBuffer(GL_ARRAY_BUFFER, out.vertices_.name());
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(),
                 GL_STATIC_DRAW);
    setAttribute(0, offsetof(Vertex, position));
    setAttribute(1, offsetof(Vertex, normal));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, out.triangles_.name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(full.triangles.size() * sizeof(full.triangles[0])),
                 full.triangles.data(), GL_STATIC_DRAW);
    RELIEF_TRY(checkAllocated("the collider's mesh", "choose a smaller one"));
    return out;
}

void ColliderMesh::setVertices(const GlBuffer& buffer) {
    copyBuffer(buffer, vertices_, 0, vertex_bytes_);
}

Result<ColliderMesh::View> ColliderMesh::view(const Camera& camera, GLsizei width, GLsizei height) const {
    const PassState state;
    RELIEF_TRY(checkTextureSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                                "the mesh's picture's pixels", "choose a smaller size"));
    forgetGlErrors();
    View view;
    view.normal = makeTexture2D(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    view.depth = makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    RELIEF_TRY(checkAllocated("the mesh's picture", "choose a smaller size"));
    const auto framebuffer = RELIEF_TRY(makeFramebuffer({view.normal.name()}, view.depth.name()));
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const glm::mat4 clip = camera.projection(aspect) * camera.view();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, width, height);
    const std::array<GLfloat, 4> nothing{};
    const GLfloat far = 1.0F;
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    glClearBufferfv(GL_DEPTH, 0, &far);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    program_.use();
    program_.set("u_clip", clip);
    glBindVertexArray(array_.name());
    glDrawElements(GL_TRIANGLES, corners_, GL_UNSIGNED_INT, nullptr);
    return view;
}

}  // namespace relief
