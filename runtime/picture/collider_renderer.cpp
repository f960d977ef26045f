#include "runtime/picture/collider_renderer.h"

#include <array>
#include <string>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/ray_passes.h"

namespace relief {
namespace {

constexpr ColliderTextures::Binding kColliderBinding{0, 0};
constexpr int kColorUnit = 0;
constexpr int kDepthUnit = 1;
constexpr int kCoarseUnit = 3;  // after the collider's three; with a mesh:
constexpr int kMeshNormalUnit = 3;
constexpr int kMeshDepthUnit = 4;

constexpr int kNormals = 13;

// For one of the four samples of a pixel.
constexpr LightRays kLightRays{.sun = 2, .sky = 6, .sun_steps = 32, .sky_steps = 5};

constexpr const char* kSmallerPicture = "choose a smaller size";

void setVector(const GlProgram& program, const char* name, const glm::vec3& v) {
    glUniform3f(uniformLocation(program, name), v.x, v.y, v.z);
}

void setViewUniforms(const GlProgram& program, const Camera& camera, const ColliderStyle& style,
                     GLsizei width, GLsizei height) {
    const float tangent = camera.tanHalfFov();
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    const glm::vec2 depth = camera.depthOfDistance();
    glUseProgram(program.name());
    setVector(program, "u_eye", camera.eye);
    setVector(program, "u_forward", camera.forward());
    setVector(program, "u_right", tangent * aspect * camera.right());
    setVector(program, "u_up", tangent * camera.up());
    glUniform2f(uniformLocation(program, "u_depth"), depth.x, depth.y);
    glUniform1i(uniformLocation(program, "u_has_ground"), style.ground ? 1 : 0);
    glUniform1f(uniformLocation(program, "u_ground"), style.ground.value_or(0.0F));
    setVector(program, "u_background", linearColor(style.background));
    setVector(program, "u_clay", linearColor(style.clay));
}

}  // namespace

Result<ColliderRenderer> ColliderRenderer::create(const ColliderView& view, const ColliderMesh* mesh) {
    RELIEF_TRY(checkContext());
    const PassState state;
    ColliderRenderer renderer;
    renderer.view_ = view;
    renderer.mesh_ = mesh;
    const std::string mesh_define = mesh != nullptr ? "#define RELIEF_MESH 1\n" : "";
    renderer.trace_program_ =
        RELIEF_TRY(makeProgram("quad.vert", "collider_view.frag", mesh_define + view.textures->defines()));
    renderer.coarse_program_ = RELIEF_TRY(makeProgram(
        "quad.vert", "collider_view.frag", "#define RELIEF_COARSE 1\n" + view.textures->defines()));
    renderer.copy_program_ = RELIEF_TRY(makeProgram("quad.vert", "copy_view.frag"));
    renderer.no_attributes_ = makeVertexArray();
    for (const GlProgram* program : {&renderer.trace_program_, &renderer.coarse_program_}) {
        view.textures->attach(*program, kColliderBinding);
        setLightUniforms(*program, view, kLightRays);
        setRayUniforms(*program, view);
        glUniform1i(uniformLocation(*program, "u_normals"), kNormals);
    }
    glUseProgram(renderer.trace_program_.name());
    glUniform1i(uniformLocation(renderer.trace_program_, "u_coarse"), kCoarseUnit);
    glUniform1i(uniformLocation(renderer.trace_program_, "u_mesh_normal"), kMeshNormalUnit);
    glUniform1i(uniformLocation(renderer.trace_program_, "u_mesh_depth"), kMeshDepthUnit);
    glUseProgram(renderer.copy_program_.name());
    glUniform1i(uniformLocation(renderer.copy_program_, "u_color"), kColorUnit);
    glUniform1i(uniformLocation(renderer.copy_program_, "u_depth_texture"), kDepthUnit);
    glUniform2i(uniformLocation(renderer.copy_program_, "u_origin"), 0, 0);
    return renderer;
}

Result<void> ColliderRenderer::draw(const Camera& camera, const ColliderStyle& style,
                                    const RenderTarget& target) {
    const PassState state;
    const Drawn wanted{camera, style, target.width, target.height, view_.textures->revision()};
    if (drawn_ != wanted) {
        drawn_.reset();
        RELIEF_TRY(trace(camera, style, target.width, target.height));
        drawn_ = wanted;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(0, 0, target.width, target.height);
    glUseProgram(copy_program_.name());
    glUniform1i(uniformLocation(copy_program_, "u_srgb"), target.srgb ? 1 : 0);
    useTexture(kColorUnit, color_);
    useTexture(kDepthUnit, depth_);
    // Depth is written only while its test is on.
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    glBindVertexArray(no_attributes_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return {};
}

Result<void> ColliderRenderer::trace(const Camera& camera, const ColliderStyle& style, GLsizei width,
                                     GLsizei height) {
    RELIEF_TRY(checkTextureSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                                "the collider's pictures", kSmallerPicture));
    forgetGlErrors();
    color_ = makeTexture2D(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    RELIEF_TRY(checkAllocated("the collider's picture", kSmallerPicture));
    const std::array<GLuint, 1> colors{color_.name()};
    auto framebuffer = RELIEF_TRY(makeFramebuffer(colors, depth_.name()));
    setViewUniforms(coarse_program_, camera, style, width, height);
    setViewUniforms(trace_program_, camera, style, width, height);
    view_.textures->bind(kColliderBinding);

    glBindVertexArray(no_attributes_.name());

    // The second pass samples the mesh's picture, or the coarse pass.
    ColliderMesh::View of_mesh;
    GlTexture coarse;
    if (mesh_ != nullptr) {
        of_mesh = RELIEF_TRY(mesh_->view(camera, width, height));
        useTexture(kMeshNormalUnit, of_mesh.normal);
        useTexture(kMeshDepthUnit, of_mesh.depth);
    } else {
        RELIEF_TRY(traceCoarse(width, height, coarse));
        useTexture(kCoarseUnit, coarse);
    }

    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glUseProgram(trace_program_.name());
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    drawInBands(width, height);
    return {};
}

Result<void> ColliderRenderer::traceCoarse(GLsizei width, GLsizei height, GlTexture& coarse) {
    const GLsizei coarse_width = (width + kCoarseStride - 1) / kCoarseStride;
    const GLsizei coarse_height = (height + kCoarseStride - 1) / kCoarseStride;
    forgetGlErrors();
    coarse = makeTexture2D(GL_R32F, coarse_width, coarse_height, GL_RED, GL_FLOAT);
    RELIEF_TRY(checkAllocated("the collider's coarse picture", kSmallerPicture));
    const std::array<GLuint, 1> colors{coarse.name()};
    const auto target = RELIEF_TRY(makeFramebuffer(colors));
    glBindFramebuffer(GL_FRAMEBUFFER, target.name());
    glUseProgram(coarse_program_.name());
    drawInBands(coarse_width, coarse_height);
    return {};
}

}  // namespace relief
