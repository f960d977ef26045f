// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/collider_mesh.h"

#include <array>
#include <glm/glm.hpp>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {

Result<ColliderMesh> ColliderMesh::create(const PictureMesh& mesh) {
    RELIEF_TRY(checkContext());
    const PassState state;
    clearGlErrors();
    ColliderMesh out;
    out.program_ = RELIEF_TRY(makeProgram("picture/mesh.vert", "picture/mesh.frag"));
    out.buffers_ = RELIEF_TRY(MeshBuffers::create(mesh));
    RELIEF_TRY(checkAllocated("the collider's mesh", "choose a smaller mesh"));
    return out;
}

Result<ColliderMesh::View> ColliderMesh::view(const Camera& camera, GLsizei width, GLsizei height) const {
    const PassState state;
    RELIEF_TRY(checkTextureSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                                "the picture of the mesh", "choose a smaller size"));
    clearGlErrors();
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
    buffers_.draw();
    return view;
}

}  // namespace relief
