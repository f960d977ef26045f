#include "runtime/depth_maps/depth_map_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <string>

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

bool isCube(const DepthMapFrame& frame) {
    return frame.format == MapFormat::kCube8;
}

/// Axes sc, tc and ma of each face of a cube, in map space (formats/README.md).
constexpr double kFaceAxes[6][3][3] = {
    {{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}, {{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}},
    {{1, 0, 0}, {0, 0, 1}, {0, 1, 0}},   {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
    {{1, 0, 0}, {0, -1, 0}, {0, 0, 1}},  {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}},
};

glm::dvec3 faceAxis(std::uint32_t face, int axis) {
    const double* const a = kFaceAxes[face][axis];
    return {a[0], a[1], a[2]};
}

/// A row of an affine map of object space, in double.
struct Row {
    glm::dvec3 direction{0.0};
    double offset = 0.0;

    [[nodiscard]] glm::vec4 from(const glm::dvec3& center) const {
        return {glm::vec3(direction), static_cast<float>(glm::dot(direction, center) + offset)};
    }
};
Row operator*(double factor, const Row& row) {
    return {factor * row.direction, factor * row.offset};
}
Row operator+(const Row& a, const Row& b) {
    return {a.direction + b.direction, a.offset + b.offset};
}

/// Coordinate k of map space.
Row mapRow(const DepthMapFrame& frame, int k) {
    const glm::dvec3 direction = frame.axis[k] / glm::dot(frame.axis[k], frame.axis[k]);
    return {direction, -glm::dot(direction, frame.origin)};
}

/// Object space to the space of depth_map.vert.
std::array<Row, 3> rowsOf(const DepthMapFrame& frame, std::uint32_t face) {
    if (!isCube(frame)) {
        return {double(frame.width) * mapRow(frame, 0), double(frame.height) * mapRow(frame, 1),
                mapRow(frame, 2)};
    }
    std::array<Row, 3> on_face;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 along = faceAxis(face, axis);
        Row& row = on_face[static_cast<std::size_t>(axis)];
        for (int k = 0; k < 3; ++k) {
            row = row + along[k] * mapRow(frame, k);
        }
    }
    return on_face;
}

/// The defines of a program.
std::string definesOf(const DepthMapFrame& frame, bool motion) {
    std::string defines;
    const auto define = [&](const char* name) { defines.append("#define ").append(name).append(" 1\n"); };
    switch (frame.format) {
        case MapFormat::kFloat32:
            define("RELIEF_FLOAT");
            break;
        case MapFormat::kFrontBackHalf:
            define("RELIEF_HALF");
            [[fallthrough]];
        case MapFormat::kFrontBackFixed:
            define("RELIEF_WORDS");
            break;
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            define("RELIEF_BYTES");
            break;
    }
    if (isCube(frame)) {
        define("RELIEF_CUBE");
        if (!frame.encloses) {
            define("RELIEF_BOUNDED");
        }
    }
    if (frame.decode == Decode::kPlane) {
        define("RELIEF_PLANE");
    }
    if (motion) {
        define("RELIEF_MOTION");
    }
    return defines;
}

/// State that PassState leaves alone because no other pass depends on it: the depth range, and on desktop GL the
/// provoking vertex and depth clamping.
class DrawState {
  public:
    DrawState() {
        glGetFloatv(GL_DEPTH_RANGE, range_);
        glDepthRangef(0.0F, 1.0F);
        if (!isGles()) {
            glGetIntegerv(GL_PROVOKING_VERTEX, &provoking_);
            glProvokingVertex(GL_LAST_VERTEX_CONVENTION);
            clamp_ = glIsEnabled(GL_DEPTH_CLAMP);
            glDisable(GL_DEPTH_CLAMP);
        }
    }
    ~DrawState() {
        glDepthRangef(range_[0], range_[1]);
        if (!isGles()) {
            glProvokingVertex(static_cast<GLenum>(provoking_));
            if (clamp_ == GL_TRUE) {
                glEnable(GL_DEPTH_CLAMP);
            }
        }
    }
    DrawState(const DrawState&) = delete;
    DrawState& operator=(const DrawState&) = delete;

  private:
    GLfloat range_[2] = {0.0F, 1.0F};
    GLint provoking_ = 0;
    GLboolean clamp_ = GL_FALSE;
};

void clearTexels(const DepthMapTarget& target) {
    if (isFrontBack(target.format())) {
        const GLuint nothing[4] = {0, 0, 0, 0};
        glClearBufferuiv(GL_COLOR, 0, nothing);
    } else {
        const GLfloat nothing[4] = {0.0F, 0.0F, 0.0F, target.format() == MapFormat::kFloat32 ? -1.0F : 0.0F};
        glClearBufferfv(GL_COLOR, 0, nothing);
    }
    if (target.motion(0) != 0) {
        const GLfloat still[4] = {0.0F, 0.0F, 0.0F, 0.0F};
        glClearBufferfv(GL_COLOR, 1, still);
        glClearBufferfv(GL_COLOR, 2, still);
    }
}

/// Viewport and scissor round a face, which is cleared.
void beginFace(const DepthMapFrame& frame, std::uint32_t face, const DepthMapTarget& target) {
    const auto y = static_cast<GLint>(face * frame.height);
    const auto width = static_cast<GLsizei>(frame.width);
    const auto height = static_cast<GLsizei>(frame.height);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
    glViewport(0, y, width, height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, y, width, height);
    clearTexels(target);
    if (!isCube(frame) && frame.decode == Decode::kPlane) {
        glScissor(1, 1, width - 2, height - 2);  // planes leave the border empty
    }
}

}  // namespace

Result<DepthMapRenderer> DepthMapRenderer::create() {
    RELIEF_TRY(checkContext());
    return DepthMapRenderer();
}

Result<const GlProgram*> DepthMapRenderer::programFor(const DepthMapFrame& frame, bool motion) {
    const std::string defines = definesOf(frame, motion);
    const auto found = programs_.find(defines);
    if (found != programs_.end()) {
        return &found->second;
    }
    GlProgram program =
        RELIEF_TRY(makeProgram("depth_maps/depth_map.vert", "depth_maps/depth_map.frag", defines));
    program.use();
    program.set("u_positions", kPositionUnit);
    program.set("u_planes", kPlaneUnit);
    program.set("u_corners", kCornerUnit);
    program.set("u_previous", kPreviousUnit);
    return &programs_.emplace(defines, std::move(program)).first->second;
}

void DepthMapRenderer::setUniforms(const GlProgram& program, const GpuMesh& mesh, const DepthMapFrame& frame,
                                   std::uint32_t face) {
    program.set("u_shift", glm::ivec2(mesh.vertexShift(), mesh.triangleShift()));
    // The middle of an orthographic volume, or a cube's, as a float: points are relative to it exactly.
    glm::dvec3 middle = frame.origin;
    if (!isCube(frame)) {
        middle += 0.5 * (frame.axis[0] + frame.axis[1] + frame.axis[2]);
    }
    const glm::vec3 center(middle);
    program.set("u_center", center);
    program.set("u_residual", glm::vec3(glm::dvec3(center) - frame.origin));
    const std::array<Row, 3> rows = rowsOf(frame, face);
    std::array<glm::vec4, 3> row;
    std::transform(rows.begin(), rows.end(), row.begin(),
                   [&](const Row& r) { return r.from(glm::dvec3(center)); });
    program.set("u_row", row);
    program.set("u_object", isCube(frame) ? glm::mat3(faceAxis(face, 0), faceAxis(face, 1), faceAxis(face, 2))
                                          : glm::mat3(frame.axis[0] / double(frame.width),
                                                      frame.axis[1] / double(frame.height), frame.axis[2]));
    program.set("u_size", glm::vec2(frame.width, frame.height));
    program.set("u_origin", glm::vec2(0.0F, static_cast<float>(face * frame.height)));
    const glm::vec3 scale(glm::length(frame.axis[0]), glm::length(frame.axis[1]), glm::length(frame.axis[2]));
    program.set("u_scale", scale);
    program.set("u_width", static_cast<float>(frame.width));
    program.set("u_ray", glm::vec3(glm::normalize(frame.axis[2])));
    program.set("u_range", standingRange(isCube(frame) ? Projection::kCube : Projection::kOrthographic, scale,
                                         frame.width, frame.height));
}

Result<void> DepthMapRenderer::render(GpuMesh& mesh, const DepthMapFrame& frame,
                                      const DepthMapTarget& target) {
    RELIEF_TRY(checkFrame(frame));
    const std::uint32_t rows = frame.height * faceCount(frame);
    if (target.format() != frame.format || target.width() < frame.width || target.height() < rows) {
        return fail(ErrorCode::kUsage, "a depth map of " + std::to_string(frame.width) + " x " +
                                           std::to_string(rows) +
                                           " texels does not fit its target; create one of its frame");
    }
    const bool motion = target.motion(0) != 0;
    const PassState state;
    const DrawState draw_state;
    const GlProgram* program = RELIEF_TRY(programFor(frame, motion));
    const GLuint planes = mesh.planes();
    useTexture(kPositionUnit, mesh.positions());
    useTexture(kPlaneUnit, planes);
    useTexture(kCornerUnit, mesh.corners());
    if (motion) {
        useTexture(kPreviousUnit, mesh.previousPositions());
    }
    program->use();
    glEnable(GL_DEPTH_TEST);
    for (std::uint32_t face = 0; face < faceCount(frame); ++face) {
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        beginFace(frame, face, target);
        setUniforms(*program, mesh, frame, face);
        for (const bool far : {false, true}) {
            if (frame.compare == (far ? Compare::kLess : Compare::kGreater)) {
                continue;
            }
            program->set("u_far", far);
            program->set("u_starts_free", frame.starts_free[far ? 1 : 0]);
            const GLfloat farthest = far ? 0.0F : 1.0F;
            glClearBufferfv(GL_DEPTH, 0, &farthest);
            glDepthFunc(far ? GL_GREATER : GL_LESS);
            if (frame.compare == Compare::kBoth) {
                // The front in the first and third channel, the back in the others.
                glColorMask(!far, far, !far, far);
            }
            mesh.draw();
        }
    }
    return {};
}

}  // namespace relief
