// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/collider_renderer.h"

#include <string>

#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr ShaderCollider::Binding kColliderBinding{0, 0};
constexpr int kColorUnit = 0;
constexpr int kDepthUnit = 1;
constexpr int kCoarseUnit = 3;  // after the three units of the collider
constexpr int kMeshNormalUnit = 3;
constexpr int kMeshDepthUnit = 4;

constexpr int kNormals = 13;

// Per sample; a pixel has four.
constexpr LightRays kLightRays{.sun = 2, .sky = 6, .sun_steps = 32, .sky_steps = 5};

constexpr const char* kSmallerPicture = "choose a smaller size";

void setViewUniforms(const GlProgram& program, const Camera& camera, const ColliderStyle& style,
                     GLsizei width, GLsizei height) {
    setCameraUniforms(program, {camera, static_cast<float>(width) / static_cast<float>(height)});
    program.set("u_has_ground", style.ground.has_value());
    program.set("u_ground", style.ground.value_or(0.0F));
    program.set("u_background", linearColor(style.background));
    program.set("u_clay", linearColor(style.clay));
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
        RELIEF_TRY(makeScreenProgram("picture/collider_view.frag", mesh_define + view.textures->defines()));
    renderer.coarse_program_ = RELIEF_TRY(makeScreenProgram(
        "picture/collider_view.frag", "#define RELIEF_COARSE 1\n" + view.textures->defines()));
    renderer.copy_program_ = RELIEF_TRY(makeScreenProgram("picture/copy_view.frag"));
    for (const GlProgram* program : {&renderer.coarse_program_, &renderer.trace_program_}) {
        view.textures->attach(*program, kColliderBinding);
        setLightUniforms(*program, view, kLightRays);
        setRayUniforms(*program, view);
        program->set("u_normals", kNormals);
        program->set("u_coarse", kCoarseUnit);
        program->set("u_mesh_normal", kMeshNormalUnit);
        program->set("u_mesh_depth", kMeshDepthUnit);
    }
    renderer.copy_program_.use();
    renderer.copy_program_.set("u_color", kColorUnit);
    renderer.copy_program_.set("u_depth_texture", kDepthUnit);
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
    copy_program_.use();
    copy_program_.set("u_srgb", target.srgb);
    useTexture(kColorUnit, color_);
    useTexture(kDepthUnit, depth_);
    // Depth is written only while its test is on.
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    copy_program_.drawScreen(target.framebuffer, target.width, target.height);
    return {};
}

Result<void> ColliderRenderer::trace(const Camera& camera, const ColliderStyle& style, GLsizei width,
                                     GLsizei height) {
    RELIEF_TRY(checkTextureSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                                "the collider's pictures", kSmallerPicture));
    clearGlErrors();
    color_ = makeTexture2D(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    RELIEF_TRY(checkAllocated("the collider's picture", kSmallerPicture));
    auto framebuffer = RELIEF_TRY(makeFramebuffer({color_.name()}, depth_.name()));
    setViewUniforms(coarse_program_, camera, style, width, height);
    setViewUniforms(trace_program_, camera, style, width, height);
    view_.textures->bind(kColliderBinding);

    // The second pass samples the picture of the mesh, or the coarse pass.
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

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_ALWAYS);
    glDepthMask(GL_TRUE);
    drawInBands(trace_program_, framebuffer.name(), width, height);
    return {};
}

Result<void> ColliderRenderer::traceCoarse(GLsizei width, GLsizei height, GlTexture& coarse) {
    const GLsizei coarse_width = (width + kCoarseStride - 1) / kCoarseStride;
    const GLsizei coarse_height = (height + kCoarseStride - 1) / kCoarseStride;
    clearGlErrors();
    coarse = makeTexture2D(GL_R32F, coarse_width, coarse_height, GL_RED, GL_FLOAT);
    RELIEF_TRY(checkAllocated("the collider's coarse picture", kSmallerPicture));
    const auto target = RELIEF_TRY(makeFramebuffer({coarse.name()}));
    drawInBands(coarse_program_, target.name(), coarse_width, coarse_height);
    return {};
}

}  // namespace relief
