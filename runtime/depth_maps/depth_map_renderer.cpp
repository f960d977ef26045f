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
std::array<Row, 3> rowsOf(const DepthMapFrame& frame, const TexelWindow& window) {
    if (!isCube(frame)) {
        return {double(frame.width) * mapRow(frame, 0) + Row{{}, -double(window.x)},
                double(frame.height) * mapRow(frame, 1) + Row{{}, -double(window.y)}, mapRow(frame, 2)};
    }
    std::array<Row, 3> on_face;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec3 along = faceAxis(window.face, axis);
        Row& row = on_face[static_cast<std::size_t>(axis)];
        for (int k = 0; k < 3; ++k) {
            row = row + along[k] * mapRow(frame, k);
        }
    }
    // The face is ±ma wide: its window becomes ±w.
    const auto clip = [&](const Row& across, std::uint32_t first, std::uint32_t size) {
        const double zoom = double(frame.width) / size;
        return zoom * across + (zoom * (1.0 - 2.0 * first / frame.width) - 1.0) * on_face[2];
    };
    return {clip(on_face[0], window.x, window.width), clip(on_face[1], window.y, window.height), on_face[2]};
}

Result<void> checkWindow(const DepthMapFrame& frame, const TexelWindow& window, const DepthMapTarget& target,
                         std::uint32_t x, std::uint32_t y) {
    const auto inside = [](std::uint32_t first, std::uint32_t size, std::uint32_t room) {
        return size > 0 && first <= room && size <= room - first;
    };
    if (window.face >= faceCount(frame) || !inside(window.x, window.width, frame.width) ||
        !inside(window.y, window.height, frame.height)) {
        return fail(ErrorCode::kUsage, "a window of a depth map lies outside of it; make it smaller");
    }
    if (target.format() != frame.format || !inside(x, window.width, target.width()) ||
        !inside(y, window.height, target.height())) {
        return fail(ErrorCode::kUsage,
                    "a depth map's window of " + std::to_string(window.width) + " x " +
                        std::to_string(window.height) +
                        " texels does not fit its target; create one of its format and size");
    }
    return {};
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
    if (frame.exact) {
        define("RELIEF_EXACT");
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

/// Viewport and scissor round the window at (x, y) of the target, which is cleared.
void beginWindow(const DepthMapFrame& frame, const TexelWindow& window, const DepthMapTarget& target,
                 std::uint32_t x, std::uint32_t y) {
    const auto corner_x = static_cast<GLint>(x);
    const auto corner_y = static_cast<GLint>(y);
    const auto width = static_cast<GLsizei>(window.width);
    const auto height = static_cast<GLsizei>(window.height);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
    glViewport(corner_x, corner_y, width, height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(corner_x, corner_y, width, height);
    clearTexels(target);
    if (!isCube(frame) && frame.decode == Decode::kPlane) {
        // Planes leave the border empty.
        const std::uint32_t left = std::max(window.x, 1U);
        const std::uint32_t below = std::max(window.y, 1U);
        const std::uint32_t right = std::max(std::min(window.x + window.width, frame.width - 1), left);
        const std::uint32_t above = std::max(std::min(window.y + window.height, frame.height - 1), below);
        glScissor(static_cast<GLint>(x + (left - window.x)), static_cast<GLint>(y + (below - window.y)),
                  static_cast<GLsizei>(right - left), static_cast<GLsizei>(above - below));
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
    const char* vertex = frame.exact ? "depth_maps/depth_map_exact.vert" : "depth_maps/depth_map.vert";
    GlProgram program = RELIEF_TRY(makeProgram(vertex, "depth_maps/depth_map.frag", defines));
    program.use();
    program.set("u_positions", kPositionUnit);
    program.set("u_planes", kPlaneUnit);
    program.set("u_corners", kCornerUnit);
    program.set("u_previous", kPreviousUnit);
    return &programs_.emplace(defines, std::move(program)).first->second;
}

void DepthMapRenderer::setUniforms(const GlProgram& program, const GpuMesh& mesh, const DepthMapFrame& frame,
                                   const TexelWindow& window, std::uint32_t x, std::uint32_t y) {
    program.set("u_shift", glm::ivec2(mesh.vertexShift(), mesh.triangleShift()));
    // The middle of an orthographic volume, or a cube's, as a float: points are relative to it exactly.
    glm::dvec3 middle = frame.origin;
    if (!isCube(frame)) {
        middle += 0.5 * (frame.axis[0] + frame.axis[1] + frame.axis[2]);
    }
    const glm::vec3 center(middle);
    program.set("u_center", center);
    program.set("u_residual", glm::vec3(glm::dvec3(center) - frame.origin));
    const std::array<Row, 3> rows = rowsOf(frame, window);
    std::array<glm::vec4, 3> row;
    std::transform(rows.begin(), rows.end(), row.begin(),
                   [&](const Row& r) { return r.from(glm::dvec3(center)); });
    program.set("u_row", row);
    program.set("u_object", isCube(frame) ? glm::mat3(faceAxis(window.face, 0), faceAxis(window.face, 1),
                                                      faceAxis(window.face, 2))
                                          : glm::mat3(frame.axis[0] / double(frame.width),
                                                      frame.axis[1] / double(frame.height), frame.axis[2]));
    program.set("u_window", glm::vec2(window.width, window.height));
    // Cube: texels count from the face's first one, which may lie outside the target.
    const double left = isCube(frame) ? double(x) - window.x : double(x);
    const double below = isCube(frame) ? double(y) - window.y : double(y);
    program.set("u_origin", glm::vec2(left, below));
    const glm::vec3 scale(glm::length(frame.axis[0]), glm::length(frame.axis[1]), glm::length(frame.axis[2]));
    program.set("u_scale", scale);
    program.set("u_width", static_cast<float>(frame.width));
    program.set("u_inside_out", frame.inside_out);
    program.set("u_ray", glm::vec3(glm::normalize(frame.axis[2])));
    program.set("u_range", standingRange(isCube(frame) ? Projection::kCube : Projection::kOrthographic, scale,
                                         frame.width, frame.height));
    program.set("u_corner", glm::vec2(x, y));
    GLint subpixel_bits = 4;  // the least there may be
    glGetIntegerv(GL_SUBPIXEL_BITS, &subpixel_bits);
    program.set("u_reach", std::ldexp(2.0F, -std::clamp(subpixel_bits, 4, 8)));
    program.set("u_good_enough", static_cast<float>(frame.good_enough));
}

Result<void> DepthMapRenderer::render(GpuMesh& mesh, const DepthMapFrame& frame,
                                      const DepthMapTarget& target) {
    for (std::uint32_t face = 0; face < faceCount(frame); ++face) {
        const TexelWindow window{face, 0, 0, frame.width, frame.height};
        RELIEF_TRY(render(mesh, frame, window, target, 0, face * frame.height));
    }
    return {};
}

Result<void> DepthMapRenderer::render(GpuMesh& mesh, const DepthMapFrame& frame, const TexelWindow& window,
                                      const DepthMapTarget& target, std::uint32_t x, std::uint32_t y) {
    RELIEF_TRY(checkFrame(frame));
    RELIEF_TRY(checkWindow(frame, window, target, x, y));
    const bool motion = target.motion(0) != 0;
    if (motion && frame.exact) {
        return fail(ErrorCode::kUsage,
                    "exact depth maps have no motion; take a target without, or leave exact out");
    }
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
    beginWindow(frame, window, target, x, y);
    program->use();
    setUniforms(*program, mesh, frame, window, x, y);
    glEnable(GL_DEPTH_TEST);
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
        if (frame.exact) {
            mesh.drawApart();
        } else {
            mesh.draw();
        }
    }
    return {};
}

}  // namespace relief
