// SPDX-License-Identifier: Apache-2.0
#include "runtime/depth_maps/depth_map_renderer.h"

#include <array>
#include <glm/glm.hpp>

#include "runtime/gl/gl_capabilities.h"
#include "runtime/gl/gl_fault.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr GLint kPositionUnit = 0;
constexpr GLint kPlaneUnit = 1;
constexpr GLint kCornerUnit = 2;
constexpr GLint kPreviousUnit = 3;

/// Saves state that PassState does not, because no other pass depends on it: the depth range, and on desktop GL the
/// provoking vertex and depth clamping.
class DrawState {
  public:
    explicit DrawState(bool gles) : gles_(gles) {
        glGetFloatv(GL_DEPTH_RANGE, range_);
        glDepthRangef(0.0F, 1.0F);
        if (!gles_) {
            glGetIntegerv(GL_PROVOKING_VERTEX, &provoking_);
            glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
            clamp_ = glIsEnabled(GL_DEPTH_CLAMP);
            glDisable(GL_DEPTH_CLAMP);
        }
    }
    ~DrawState() {
        glDepthRangef(range_[0], range_[1]);
        if (!gles_) {
            glProvokingVertex(static_cast<GLenum>(provoking_));
            if (clamp_ == GL_TRUE) {
                glEnable(GL_DEPTH_CLAMP);
            }
        }
    }
    DrawState(const DrawState&) = delete;
    DrawState& operator=(const DrawState&) = delete;

  private:
    bool gles_;
    GLfloat range_[2] = {0.0F, 1.0F};
    GLint provoking_ = 0;
    GLboolean clamp_ = GL_FALSE;
};

}  // namespace

Result<DepthMapRenderer> DepthMapRenderer::create(std::uint32_t width, std::uint32_t height) {
    RELIEF_TRY(checkContext());
    constexpr const char* kFix = "choose smaller ones";
    RELIEF_TRY(checkTextureSize(width, height, "depth maps", kFix));
    const PassState state;
    DepthMapRenderer renderer;
    renderer.gles_ = isGles();
    renderer.width_ = width;
    renderer.height_ = height;
    const auto w = static_cast<GLsizei>(width);
    const auto h = static_cast<GLsizei>(height);
    clearGlErrors();
    renderer.texels_ = makeTexture2D(GL_RGBA16UI, w, h, GL_RGBA_INTEGER, GL_UNSIGNED_SHORT);
    renderer.depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, w, h, GL_DEPTH_COMPONENT, GL_FLOAT);
    for (GlTexture& motion : renderer.motion_) {
        motion = makeTexture2D(GL_RGBA32F, w, h, GL_RGBA, GL_FLOAT);
    }
    RELIEF_TRY(checkAllocated("depth maps", kFix));
    renderer.framebuffer_ = RELIEF_TRY(makeFramebuffer(
        {renderer.texels_.name(), renderer.motion(0), renderer.motion(1)}, renderer.depth_.name()));
    renderer.program_ = RELIEF_TRY(makeProgram("depth_maps/depth_map.vert", "depth_maps/depth_map.frag"));
    renderer.program_.use();
    renderer.program_.set("u_positions", kPositionUnit);
    renderer.program_.set("u_planes", kPlaneUnit);
    renderer.program_.set("u_corners", kCornerUnit);
    renderer.program_.set("u_previous", kPreviousUnit);
    return renderer;
}

void DepthMapRenderer::setUniforms(const GpuMesh& mesh, const DepthMap& map) const {
    // The rows are orthogonal, so the columns of the inverse (one unit along each map axis in object space) are the
    // rows divided by their squared lengths.
    glm::dvec3 axis[3];
    glm::dvec3 origin(0.0);
    for (int k = 0; k < 3; ++k) {
        const glm::dvec4 row(map.object_to_map.row[k]);
        axis[k] = glm::dvec3(row) / glm::dot(glm::dvec3(row), glm::dvec3(row));
        origin -= row.w * axis[k];
    }
    // The centre of the volume, rounded to a float, so that subtracting it from points is exact.
    const glm::vec3 center(origin + 0.5 * (axis[0] + axis[1] + axis[2]));
    const glm::dvec3 size(map.width, map.height, 1.0);
    std::array<glm::vec4, 3> rows;
    for (int k = 0; k < 3; ++k) {
        const glm::dvec3 unit = axis[k] / glm::dot(axis[k], axis[k]);
        const glm::dvec3 direction = size[k] * unit;
        const double offset = size[k] * -glm::dot(unit, origin);
        rows[static_cast<std::size_t>(k)] = glm::vec4(
            glm::vec3(direction), static_cast<float>(glm::dot(direction, glm::dvec3(center)) + offset));
    }
    const glm::vec3 scale(glm::length(axis[0]), glm::length(axis[1]), glm::length(axis[2]));
    program_.set("u_shift", glm::ivec2(mesh.vertexShift(), mesh.triangleShift()));
    program_.set("u_center", center);
    program_.set("u_row", rows);
    program_.set("u_object", glm::mat3(axis[0] / size.x, axis[1] / size.y, axis[2]));
    program_.set("u_size", glm::vec2(size));
    program_.set("u_ray", scale.z * glm::vec3(glm::normalize(axis[2])));
    program_.set("u_starts_free", map.encloses);
}

void DepthMapRenderer::render(GpuMesh& mesh, const DepthMap& map) const {
    const PassState state;
    renderInPass(mesh, map);
}

void DepthMapRenderer::renderInPass(GpuMesh& mesh, const DepthMap& map) const {
    const DrawState draw_state(gles_);
    const GLuint planes = mesh.planes();
    useTexture(kPositionUnit, mesh.positions());
    useTexture(kPlaneUnit, planes);
    useTexture(kCornerUnit, mesh.corners());
    useTexture(kPreviousUnit, mesh.previousPositions());
    program_.use();
    setUniforms(mesh, map);
    const auto width = static_cast<GLsizei>(map.width);
    const auto height = static_cast<GLsizei>(map.height);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, width, height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, width, height);
    const GLuint nothing[4] = {};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    glEnable(GL_DEPTH_TEST);
    glScissor(1, 1, width - 2, height - 2);  // plane maps have an empty border
    for (const bool far : {false, true}) {
        program_.set("u_far", far);
        const GLfloat farthest = far ? 0.0F : 1.0F;
        glClearBufferfv(GL_DEPTH, 0, &farthest);
        glDepthFunc(far ? GL_GREATER : GL_LESS);
        // The front uses channels 1 and 3, the back channels 2 and 4.
        glColorMask(!far, far, !far, far);
        mesh.draw();
    }
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace relief
