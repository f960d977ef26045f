#include "runtime/depth_map_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <string>
#include <vector>

#include "runtime/pass_state.h"

namespace relief {
namespace {

/// Surfaces this much of the depth range outside the volume are drawn, and their depth clamped: one in a face
/// of the volume is met in spite of rounding. As kDepthSlack of bake/view.h.
constexpr const char* kSlack = "#define RELIEF_SLACK 1e-6\n";

constexpr GLint kPositionUnit = 0;
constexpr GLint kPlaneUnit = 1;
constexpr GLint kCornerUnit = 2;
constexpr GLint kPreviousUnit = 3;

struct TexelLayout {
    GLenum internal_format;
    GLenum format;
    GLenum type;  // of read and upload
};

TexelLayout layoutOf(MapFormat format) {
    switch (format) {
        case MapFormat::kFloat32:
            return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
        case MapFormat::kFrontBackHalf:
        case MapFormat::kFrontBackFixed:
            // Two-byte integers are not among what OpenGL ES 3.0 must read back.
            return {GL_RGBA16UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
        case MapFormat::kFixed8:
        case MapFormat::kCube8:
            break;
    }
    return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
}

bool isCube(const DepthMapFrame& frame) {
    return frame.format == MapFormat::kCube8;
}

std::uint32_t faceCount(const DepthMapFrame& frame) {
    return isCube(frame) ? 6 : 1;
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

/// What depth_map.vert takes a point of object space to.
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

Result<void> checkFrame(const DepthMapFrame& frame) {
    const std::uint32_t least = isCube(frame) ? 1 : kMapSizeMin;
    if (std::min(frame.width, frame.height) < least || std::max(frame.width, frame.height) > kMapSizeMax ||
        (isCube(frame) && frame.width != frame.height)) {
        return fail(ErrorCode::kUsage,
                    "a depth map of " + std::to_string(frame.width) + " x " + std::to_string(frame.height) +
                        " texels cannot be rendered; take " + std::to_string(least) + " to " +
                        std::to_string(kMapSizeMax) + " along a side, a cube as wide as high");
    }
    if ((frame.compare == Compare::kBoth) != isFrontBack(frame.format)) {
        return fail(ErrorCode::kUsage, std::string("a depth map of format ") + mapFormatName(frame.format) +
                                           " cannot keep " + compareName(frame.compare) +
                                           "; front-back maps, and only those, keep both surfaces");
    }
    for (int k = 0; k < 3; ++k) {
        const Row row = mapRow(frame, k);
        const glm::vec3 direction(row.direction);
        const double length = glm::length(frame.axis[k]);
        if (!(std::isfinite(direction.x) && std::isfinite(direction.y) && std::isfinite(direction.z)) ||
            !std::isfinite(static_cast<float>(row.offset)) || !(static_cast<float>(length) > 0.0F) ||
            !std::isfinite(static_cast<float>(length))) {
            return fail(
                ErrorCode::kUsage,
                "a depth map has an axis " + std::to_string(k) +
                    " that floats cannot hold; its axes must have a length, and its origin be finite");
        }
    }
    return {};
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

/// What a program is compiled for.
std::string definesOf(const DepthMapFrame& frame, bool motion) {
    std::string defines = kSlack;
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

void useTexture(GLint unit, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, texture);
}

void setVector(GLint location, const glm::dvec3& v) {
    glUniform3f(location, static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}

/// What PassState leaves alone because no other pass depends on it: the depth range, and on desktop GL the
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

}  // namespace

DepthMapFrame frameOf(const DepthMap& map) {
    DepthMapFrame frame;
    frame.format = map.format;
    frame.compare = map.compare;
    frame.decode = map.decode;
    frame.width = map.width;
    frame.height = map.height;
    // The rows are orthogonal, so that the columns of the inverse are the rows over their squared lengths.
    for (int k = 0; k < 3; ++k) {
        const glm::vec4& row = map.object_to_map.row[k];
        const glm::dvec3 direction(row.x, row.y, row.z);
        frame.axis[k] = direction / glm::dot(direction, direction);
        frame.origin -= double(row.w) * frame.axis[k];
    }
    frame.encloses = map.encloses;
    frame.starts_free[0] = isCube(frame) || map.encloses;
    frame.starts_free[1] = map.encloses;
    return frame;
}

Result<DepthMapTarget> DepthMapTarget::create(MapFormat format, std::uint32_t width, std::uint32_t height,
                                              bool motion) {
    GLint side = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    GLint viewport[2] = {};
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    const auto most = static_cast<std::uint32_t>(std::min({side, viewport[0], viewport[1]}));
    if (width == 0 || height == 0 || std::max(width, height) > most) {
        return fail(ErrorCode::kLimit, "depth maps of " + std::to_string(width) + " x " +
                                           std::to_string(height) +
                                           " texels cannot be rendered at once; this GL takes 1 to " +
                                           std::to_string(most) + " along a side");
    }
    if (isGles() && (motion || format == MapFormat::kFloat32) &&
        !epoxy_has_gl_extension("GL_EXT_color_buffer_float")) {
        return fail(ErrorCode::kUnsupported,
                    "GL_EXT_color_buffer_float is missing, float depth maps and motion cannot be rendered; "
                    "take another format, or OpenGL 3.3");
    }
    const PassState state;
    DepthMapTarget target;
    target.format_ = format;
    target.width_ = width;
    target.height_ = height;
    const TexelLayout layout = layoutOf(format);
    const auto w = static_cast<GLsizei>(width);
    const auto h = static_cast<GLsizei>(height);
    // Integers of two bytes are allocated as such, whatever they are read back as.
    target.texels_ = makeTexture2D(layout.internal_format, w, h, layout.format,
                                   isFrontBack(format) ? GL_UNSIGNED_SHORT : layout.type);
    target.depth_ = makeTexture2D(GL_DEPTH_COMPONENT32F, w, h, GL_DEPTH_COMPONENT, GL_FLOAT);
    std::vector<GLuint> colors = {target.texels_.name()};
    for (int i = 0; motion && i < 2; ++i) {
        target.motion_[i] = makeTexture2D(GL_RGBA32F, w, h, GL_RGBA, GL_FLOAT);
        colors.push_back(target.motion_[i].name());
    }
    auto framebuffer = makeFramebuffer(colors, target.depth_.name());
    if (!framebuffer) {
        return forward(framebuffer);
    }
    target.framebuffer_ = std::move(*framebuffer);
    return target;
}

Result<DepthMapTarget> DepthMapTarget::create(const DepthMapFrame& frame, bool motion) {
    if (auto good = checkFrame(frame); !good) {
        return forward(good);
    }
    return create(frame.format, frame.width, frame.height * faceCount(frame), motion);
}

Result<void> DepthMapTarget::read(std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
                                  std::span<std::byte> bytes) const {
    const std::size_t texels = std::size_t{width} * height;
    if (x > width_ || width > width_ - x || y > height_ || height > height_ - y ||
        bytes.size() != texels * texelSize(format_)) {
        return fail(ErrorCode::kUsage,
                    "texels to read lie outside of the target, or their room has another size");
    }
    const PassState state;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_.name());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    const TexelLayout layout = layoutOf(format_);
    const auto readTo = [&](void* to) {
        glReadPixels(static_cast<GLint>(x), static_cast<GLint>(y), static_cast<GLsizei>(width),
                     static_cast<GLsizei>(height), layout.format, layout.type, to);
    };
    if (!isFrontBack(format_)) {
        readTo(bytes.data());
        return {};
    }
    std::vector<std::uint32_t> words(4 * texels);
    readTo(words.data());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const auto word = static_cast<std::uint16_t>(words[i]);
        std::memcpy(&bytes[2 * i], &word, sizeof(word));
    }
    return {};
}

Result<DepthMapRenderer> DepthMapRenderer::create() {
    return DepthMapRenderer();
}

Result<const DepthMapRenderer::Program*> DepthMapRenderer::programFor(const DepthMapFrame& frame,
                                                                      bool motion) {
    const std::string defines = definesOf(frame, motion);
    const auto found = programs_.find(defines);
    if (found != programs_.end()) {
        return &found->second;
    }
    auto made =
        makeProgram(frame.exact ? "depth_map_exact.vert" : "depth_map.vert", "depth_map.frag", defines);
    if (!made) {
        return forward(made);
    }
    Program program;
    program.program = std::move(*made);
    const auto at = [&](const char* name) { return uniformLocation(program.program, name); };
    program.shift = at("u_shift");
    program.center = at("u_center");
    program.row = at("u_row");
    program.object = at("u_object");
    program.window = at("u_window");
    program.residual = at("u_residual");
    program.origin = at("u_origin");
    program.scale = at("u_scale");
    program.width = at("u_width");
    program.far = at("u_far");
    program.starts_free = at("u_starts_free");
    program.inside_out = at("u_inside_out");
    program.ray = at("u_ray");
    program.range = at("u_range");
    program.good_enough = at("u_good_enough");
    program.corner = at("u_corner");
    program.reach = at("u_reach");
    glUseProgram(program.program.name());
    glUniform1i(at("u_positions"), kPositionUnit);
    glUniform1i(at("u_planes"), kPlaneUnit);
    glUniform1i(at("u_corners"), kCornerUnit);
    glUniform1i(at("u_previous"), kPreviousUnit);
    return &programs_.emplace(defines, std::move(program)).first->second;
}

void DepthMapRenderer::setUniforms(const Program& program, const GpuMesh& mesh, const DepthMapFrame& frame,
                                   const TexelWindow& window, std::uint32_t x, std::uint32_t y) {
    glUniform2i(program.shift, mesh.vertexShift(), mesh.triangleShift());
    // The middle of an orthographic volume, or a cube's, as a float: points are told from it exactly.
    glm::dvec3 middle = frame.origin;
    if (!isCube(frame)) {
        middle += 0.5 * (frame.axis[0] + frame.axis[1] + frame.axis[2]);
    }
    const glm::vec3 center(middle);
    glUniform3f(program.center, center.x, center.y, center.z);
    setVector(program.residual, glm::dvec3(center) - frame.origin);
    const std::array<Row, 3> rows = rowsOf(frame, window);
    std::array<glm::vec4, 3> row;
    std::transform(rows.begin(), rows.end(), row.begin(),
                   [&](const Row& r) { return r.from(glm::dvec3(center)); });
    glUniform4fv(program.row, 3, &row[0].x);

    std::array<glm::vec3, 3> object;
    if (isCube(frame)) {
        for (int axis = 0; axis < 3; ++axis) {
            object[static_cast<std::size_t>(axis)] = glm::vec3(faceAxis(window.face, axis));
        }
    } else {
        object = {glm::vec3(frame.axis[0] / double(frame.width)),
                  glm::vec3(frame.axis[1] / double(frame.height)), glm::vec3(frame.axis[2])};
    }
    glUniformMatrix3fv(program.object, 1, GL_FALSE, &object[0].x);
    glUniform2f(program.window, static_cast<float>(window.width), static_cast<float>(window.height));
    // Cube: texels count from the face's first one, which may lie outside the target.
    const double left = isCube(frame) ? double(x) - window.x : double(x);
    const double below = isCube(frame) ? double(y) - window.y : double(y);
    glUniform2f(program.origin, static_cast<float>(left), static_cast<float>(below));
    const glm::vec3 scale(glm::length(frame.axis[0]), glm::length(frame.axis[1]), glm::length(frame.axis[2]));
    glUniform3f(program.scale, scale.x, scale.y, scale.z);
    glUniform1f(program.width, static_cast<float>(frame.width));
    glUniform1i(program.inside_out, frame.inside_out ? 1 : 0);
    setVector(program.ray, glm::normalize(frame.axis[2]));
    glUniform1f(program.range, standingRange(isCube(frame) ? Projection::kCube : Projection::kOrthographic,
                                             scale, frame.width, frame.height));
    glUniform2f(program.corner, static_cast<float>(x), static_cast<float>(y));
    GLint subpixel_bits = 4;  // the least there may be
    glGetIntegerv(GL_SUBPIXEL_BITS, &subpixel_bits);
    glUniform1f(program.reach, std::ldexp(2.0F, -std::clamp(subpixel_bits, 4, 8)));
    glUniform1f(program.good_enough, static_cast<float>(frame.good_enough));
}

Result<void> DepthMapRenderer::render(GpuMesh& mesh, const DepthMapFrame& frame,
                                      const DepthMapTarget& target) {
    for (std::uint32_t face = 0; face < faceCount(frame); ++face) {
        const TexelWindow window{face, 0, 0, frame.width, frame.height};
        if (auto done = render(mesh, frame, window, target, 0, face * frame.height); !done) {
            return done;
        }
    }
    return {};
}

Result<void> DepthMapRenderer::render(GpuMesh& mesh, const DepthMapFrame& frame, const TexelWindow& window,
                                      const DepthMapTarget& target, std::uint32_t x, std::uint32_t y) {
    if (auto good = checkFrame(frame); !good) {
        return good;
    }
    if (auto good = checkWindow(frame, window, target, x, y); !good) {
        return good;
    }
    const bool motion = target.motion(0) != 0;
    if (motion && frame.exact) {
        return fail(ErrorCode::kUsage,
                    "exact depth maps have no motion; take a target without, or leave exact out");
    }
    const PassState state;
    const DrawState draw_state;
    const Result<const Program*> program = programFor(frame, motion);
    if (!program) {
        return forward(program);
    }
    const GLuint planes = mesh.planes();
    useTexture(kPositionUnit, mesh.positions());
    useTexture(kPlaneUnit, planes);
    useTexture(kCornerUnit, mesh.corners());
    if (motion) {
        useTexture(kPreviousUnit, mesh.previousPositions());
    }
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
    glViewport(static_cast<GLint>(x), static_cast<GLint>(y), static_cast<GLsizei>(window.width),
               static_cast<GLsizei>(window.height));
    glEnable(GL_SCISSOR_TEST);
    glScissor(static_cast<GLint>(x), static_cast<GLint>(y), static_cast<GLsizei>(window.width),
              static_cast<GLsizei>(window.height));
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
    glUseProgram((*program)->program.name());
    setUniforms(**program, mesh, frame, window, x, y);
    glEnable(GL_DEPTH_TEST);
    for (const bool far : {false, true}) {
        if (frame.compare == (far ? Compare::kLess : Compare::kGreater)) {
            continue;
        }
        glUniform1i((*program)->far, far ? 1 : 0);
        glUniform1i((*program)->starts_free, frame.starts_free[far ? 1 : 0] ? 1 : 0);
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
