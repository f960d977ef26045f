// SPDX-License-Identifier: Apache-2.0
#include "runtime/picture/mesh_renderer.h"

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <utility>

#include "formats/base/finite.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/collider_view.h"

namespace relief {
namespace {

constexpr GLsizei kMapSide = 4096;     // texels of the maps towards the sun and the zenith
constexpr GLsizei kPrintSide = 4096;   // texels of the footprints, seen from below
constexpr float kSoleHeight = 0.035F;  // height up to which geometry leaves footprints, metres
constexpr std::array<GLfloat, 4> kNothing{};

constexpr const char* kSmallerPicture = "choose a smaller size";

glm::mat4 placeMatrix(const Pose& pose) {
    const glm::mat4 turned = glm::translate(glm::mat4(1.0F), pose.position) * glm::mat4_cast(pose.rotation);
    return glm::scale(turned, glm::vec3(pose.scale));
}

void keepNearest() {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glDepthMask(GL_TRUE);
}

/// Sets the default front face for a pass.
class Facing {
  public:
    Facing() {
        glGetIntegerv(GL_FRONT_FACE, &before_);
        glFrontFace(GL_CCW);
    }
    ~Facing() { glFrontFace(static_cast<GLenum>(before_)); }
    Facing(const Facing&) = delete;
    Facing& operator=(const Facing&) = delete;

  private:
    GLint before_ = GL_CCW;
};

/// Returns an orthographic clip matrix that covers a box, for a view along −`towards`.
glm::mat4 parallelClip(const Bounds& box, const glm::vec3& towards) {
    const glm::vec3 aside =
        std::abs(towards.y) > 0.9F ? glm::vec3(0.0F, 0.0F, -1.0F) : glm::vec3(0.0F, 1.0F, 0.0F);
    const glm::mat4 view = glm::lookAt(box.center() + towards, box.center(), aside);
    Bounds seen;
    for (unsigned i = 0; i < 8; ++i) {
        seen.add(glm::vec3(view * glm::vec4(box.corner(i), 1.0F)));
    }
    const float margin = 0.01F * seen.longestSide();
    // Also include geometry on the side of the viewer, because it casts shadows into the box.
    const float above = 2.0F * seen.longestSide();
    return glm::ortho(seen.min.x - margin, seen.max.x + margin, seen.min.y - margin, seen.max.y + margin,
                      -seen.max.z - above, -seen.min.z + margin) *
           view;
}

}  // namespace

Result<MeshRenderer> MeshRenderer::create(std::span<const PictureMesh> meshes) {
    RELIEF_TRY(checkContext());
    const PassState state;
    clearGlErrors();
    MeshRenderer renderer;
    for (const PictureMesh& mesh : meshes) {
        MeshBuffers buffers = RELIEF_TRY(MeshBuffers::create(mesh));
        renderer.meshes_.push_back({mesh, std::move(buffers)});
    }
    renderer.surface_program_ =
        RELIEF_TRY(makeProgram("picture/mesh_surface.vert", "picture/mesh_surface.frag"));
    renderer.depth_program_ = RELIEF_TRY(makeProgram("picture/mesh_surface.vert", "base/nothing.frag"));
    renderer.print_program_ = RELIEF_TRY(makeProgram("picture/mesh_surface.vert", "picture/mesh_print.frag"));
    renderer.shade_program_ = RELIEF_TRY(makeScreenProgram("picture/mesh_shade.frag"));
    for (ParallelMap* map : {&renderer.sun_, &renderer.zenith_}) {
        map->depth = makeTexture2D(GL_DEPTH_COMPONENT32F, kMapSide, kMapSide, GL_DEPTH_COMPONENT, GL_FLOAT);
    }
    renderer.prints_ = makeTexture2D(GL_R8, kPrintSide, kPrintSide, GL_RED, GL_UNSIGNED_BYTE);
    RELIEF_TRY(checkAllocated("the meshes of a picture", "choose smaller ones"));
    for (ParallelMap* map : {&renderer.sun_, &renderer.zenith_}) {
        map->framebuffer = RELIEF_TRY(makeFramebuffer({}, map->depth.name()));
    }
    renderer.prints_target_ = RELIEF_TRY(makeFramebuffer({renderer.prints_.name()}));
    return renderer;
}

Result<void> MeshRenderer::setPositions(std::size_t mesh, std::span<const glm::vec3> positions) {
    if (mesh >= meshes_.size() || positions.size() != meshes_[mesh].shape.positions.size()) {
        return fail(ErrorCode::kUsage, "the mesh does not exist, or has a different number of vertices");
    }
    if (!std::all_of(positions.begin(), positions.end(), [](const glm::vec3& p) { return isFinite(p); })) {
        return invalidInput("a position of the mesh is not finite");
    }
    const PassState state;
    Mesh& to = meshes_[mesh];
    if (to.moving) {
        to.moving->setPositions(positions);
        to.buffers.setVertices(to.moving->mesh());
        return {};
    }
    MovingMesh moving(to.shape);
    moving.setPositions(positions);
    clearGlErrors();
    MeshBuffers buffers = RELIEF_TRY(MeshBuffers::create(moving.mesh()));
    RELIEF_TRY(checkAllocated("the meshes of a picture", "choose smaller ones"));
    to.moving = std::move(moving);
    to.buffers = std::move(buffers);
    return {};
}

Result<void> MeshRenderer::resize(GLsizei width, GLsizei height) {
    if (width == width_ && height == height_) {
        return {};
    }
    RELIEF_TRY(checkTextureSize(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height),
                                "a picture's pixels", kSmallerPicture));
    clearGlErrors();
    width_ = 0;
    color_ = makeTexture2D(GL_RGBA8, width, height, GL_RGBA, GL_UNSIGNED_BYTE);
    normal_ = makeTexture2D(GL_RGBA16F, width, height, GL_RGBA, GL_HALF_FLOAT);
    depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, width, height, GL_DEPTH_COMPONENT, GL_FLOAT);
    RELIEF_TRY(checkAllocated("a picture", kSmallerPicture));
    surface_ = RELIEF_TRY(makeFramebuffer({color_.name(), normal_.name()}, depth_.name()));
    width_ = width;
    height_ = height;
    return {};
}

void MeshRenderer::drawPlaces(const GlProgram& program, std::span<const MeshInstance> places, bool still,
                              bool moving) const {
    for (const MeshInstance& place : places) {
        if (place.moves ? !moving : !still) {
            continue;
        }
        const Mesh& mesh = meshes_[place.mesh];
        program.set("u_place", placeMatrix(place.pose));
        program.set("u_colored", !mesh.shape.colors.empty());
        mesh.buffers.draw();
    }
}

void MeshRenderer::drawMap(const ParallelMap& map, std::span<const MeshInstance> places, bool moving) const {
    glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer.name());
    glViewport(0, 0, kMapSide, kMapSide);
    const GLfloat far = 1.0F;
    glClearBufferfv(GL_DEPTH, 0, &far);
    depth_program_.use();
    depth_program_.set("u_clip", map.clip);
    drawPlaces(depth_program_, places, true, moving);
}

void MeshRenderer::drawPrints(std::span<const MeshInstance> places, float units_per_meter) {
    glDisable(GL_DEPTH_TEST);
    glBindFramebuffer(GL_FRAMEBUFFER, prints_target_.name());
    glViewport(0, 0, kPrintSide, kPrintSide);
    print_program_.use();
    print_program_.set("u_clip", zenith_.clip);
    print_program_.set("u_zenith", 0);
    // The factor 0.5 converts clip depth to window depth, whose range is half as large.
    print_program_.set("u_sole", 0.5F * kSoleHeight * units_per_meter *
                                     glm::length(glm::vec3(glm::transpose(zenith_.clip)[2])));
    useTexture(0, zenith_.depth);
    drawPlaces(print_program_, places, false, true);
    glEnable(GL_DEPTH_TEST);
}

Result<void> MeshRenderer::checkPlaces(std::span<const MeshInstance> places) const {
    for (const MeshInstance& place : places) {
        if (place.mesh >= meshes_.size()) {
            return fail(ErrorCode::kUsage, "there is no mesh " + std::to_string(place.mesh) +
                                               "; the number of meshes is " + std::to_string(meshes_.size()));
        }
    }
    return {};
}

void MeshRenderer::drawZenith(std::span<const MeshInstance> places, const Bounds& around) {
    zenith_.clip = parallelClip(around, glm::vec3(0.0F, 1.0F, 0.0F));
    drawMap(zenith_, places, false);
    if (!(around_ == around)) {
        glBindFramebuffer(GL_FRAMEBUFFER, prints_target_.name());
        glClearBufferfv(GL_COLOR, 0, kNothing.data());
        around_ = around;
    }
}

Result<void> MeshRenderer::press(std::span<const MeshInstance> places, float units_per_meter,
                                 const Bounds& around) {
    RELIEF_TRY(checkPlaces(places));
    const PassState state;
    if (!(around_ == around)) {
        keepNearest();
        drawZenith(places, around);
    }
    drawPrints(places, units_per_meter);
    return {};
}

Result<void> MeshRenderer::draw(const CameraMatrices& camera, const MeshStyle& style,
                                std::span<const MeshInstance> places, const Bounds& around,
                                const RenderTarget& target) {
    RELIEF_TRY(checkPlaces(places));
    const PassState state;
    const Facing facing;
    RELIEF_TRY(resize(target.width, target.height));
    keepNearest();
    sun_.clip = parallelClip(around, sunDirection());
    drawMap(sun_, places, true);
    drawZenith(places, around);
    drawPrints(places, style.units_per_meter);

    glBindFramebuffer(GL_FRAMEBUFFER, surface_.name());
    glViewport(0, 0, width_, height_);
    const GLfloat far = 1.0F;
    glClearBufferfv(GL_COLOR, 0, kNothing.data());
    glClearBufferfv(GL_COLOR, 1, kNothing.data());
    glClearBufferfv(GL_DEPTH, 0, &far);
    const glm::mat4 clip = camera.projection * camera.view;
    surface_program_.use();
    surface_program_.set("u_clip", clip);
    surface_program_.set("u_clay", style.clay);
    drawPlaces(surface_program_, places, true, true);

    const GlProgram& shade = shade_program_;
    shade.use();
    const std::array<const GlTexture*, 6> textures{&color_,     &normal_,       &depth_,
                                                   &sun_.depth, &zenith_.depth, &prints_};
    const std::array<const char*, 6> samplers{"u_surface_color", "u_surface_normal", "u_surface_depth",
                                              "u_sun_depth",     "u_zenith_depth",   "u_prints"};
    for (std::size_t i = 0; i < textures.size(); ++i) {
        useTexture(static_cast<int>(i), *textures[i]);
        shade.set(samplers[i], static_cast<GLint>(i));
    }
    setCameraUniforms(shade, camera);
    shade.set("u_clip", clip);
    shade.set("u_sun_clip", sun_.clip);
    shade.set("u_zenith_clip", zenith_.clip);
    shade.set("u_sun", sunDirection());
    shade.set("u_background", linearColor(style.background));
    shade.set("u_sunlight", style.sun);
    shade.set("u_per_fog", style.fog_distance > 0.0F ? 1.0F / style.fog_distance : 0.0F);
    shade.set("u_wet", style.wet);
    shade.set("u_snow", style.snow);
    shade.set("u_meter", style.units_per_meter);
    shade.set("u_srgb", target.srgb);
    glDepthFunc(GL_ALWAYS);
    drawInBands(shade, target.framebuffer, target.width, target.height);
    return {};
}

}  // namespace relief
