// relief-bench-depth-maps MESH: what it costs to render the depth maps of a mesh (OBJ or PLY), beside a bare
// draw of the same triangles into targets of the same formats: the same indices over plain positions, one
// colour, the depth test, as many draws and clears. Prints JSON. Of each set of maps: medians of the GPU's
// own clock, and of the wall's from glFinish to glFinish, a whole set at once; with_planes_ms where the
// positions have changed before it, upload of them excluded.
#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>
#include <vector>

#include "formats/collider.h"
#include "runtime/bench/bench_tool.h"
#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/files/mesh_file.h"
#include "runtime/gl/gl_context.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/gpu_timer.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr std::uint32_t kSize = 512;
constexpr int kRepeatsLeast = 5;
constexpr int kRepeatsMost = 200;
constexpr double kSeconds = 1.0;  // of repeats for one measurement

struct Times {
    double gpu_ms = 0.0;  ///< 0: this GL does not measure it
    double wall_ms = 0.0;
};

/// \param before  done before each run, not measured.
Times measure(
    const std::function<void()>& work, const std::function<void()>& before = [] {}) {
    GpuTimer timer;
    std::vector<double> gpu;
    std::vector<double> wall;
    double sum = 0.0;
    double gpu_before = 0.0;
    for (int i = 0; i < kRepeatsMost && (i < kRepeatsLeast || sum < 1000.0 * kSeconds); ++i) {
        before();
        glFinish();
        const Stopwatch watch;
        timer.begin(Stage::kDraw);
        work();
        timer.end();
        glFinish();
        const double ms = watch.ms();
        const StageTime& time = timer.times()[static_cast<std::size_t>(Stage::kDraw)];
        sum += ms;
        if (i > 0) {  // in the first the driver compiles
            wall.push_back(ms);
            if (time.gpu_runs > 0) {
                gpu.push_back(time.gpu_ms - gpu_before);
            }
        }
        gpu_before = time.gpu_ms;
    }
    return {median(gpu), median(wall)};
}

/// A view along one axis, or a cube, round the whole box.
DepthMapFrame frameFor(const Bounds& box, MapFormat format, Compare compare, Decode decode, int along) {
    DepthMapFrame frame;
    frame.format = format;
    frame.compare = compare;
    frame.decode = decode;
    frame.width = frame.height = kSize;
    const glm::dvec3 size = 1.02 * glm::dvec3(box.max - box.min);
    const glm::dvec3 middle = glm::dvec3(box.center());
    const bool cube = format == MapFormat::kCube8;
    frame.origin = cube ? middle : middle - 0.5 * size;
    for (int k = 0; k < 3; ++k) {
        glm::dvec3 axis(0.0);
        const int of = cube ? k : (along + 1 + k) % 3;
        axis[of] = cube ? 0.5 * size[of] : size[of];
        frame.axis[k] = axis;
    }
    return frame;
}

/// The bare draw: the mesh's triangles over plain positions.
class BareMesh {
  public:
    static Result<BareMesh> create(const PictureMesh& mesh) {
        BareMesh bare;
        for (int words = 0; words < 2; ++words) {
            bare.program_[words] = RELIEF_TRY(makeProgram("bare_draw.vert", "bare_draw.frag",
                                                          words == 0 ? "" : "#define RELIEF_WORDS 1\n"));
        }
        bare.corners_ = static_cast<GLsizei>(mesh.triangles.size());
        bare.positions_ = makeBuffer();
        bare.triangles_ = makeBuffer();
        bare.array_ = makeVertexArray();
        glBindVertexArray(bare.array_.name());
        glBindBuffer(GL_ARRAY_BUFFER, bare.positions_.name());
        glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.positions.size() * sizeof(glm::vec3)),
                     mesh.positions.data(), GL_STATIC_DRAW);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, bare.triangles_.name());
        glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                     static_cast<GLsizeiptr>(mesh.triangles.size() * sizeof(std::uint32_t)),
                     mesh.triangles.data(), GL_STATIC_DRAW);
        glBindVertexArray(0);
        return bare;
    }

    void draw(const DepthMapFrame& frame, const DepthMapTarget& target) const {
        const PassState state;
        const GlProgram& program = program_[isFrontBack(frame.format) ? 1 : 0];
        glUseProgram(program.name());
        glBindVertexArray(array_.name());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
        glEnable(GL_DEPTH_TEST);
        glEnable(GL_SCISSOR_TEST);
        const std::uint32_t faces = target.height() / frame.height;
        for (std::uint32_t face = 0; face < faces; ++face) {
            const auto y = static_cast<GLint>(face * frame.height);
            glViewport(0, y, kSize, kSize);
            glScissor(0, y, kSize, kSize);
            clear(frame);
            const glm::mat4 clip = faces == 1 ? orthographic(frame) : perspective(frame, face);
            glUniformMatrix4fv(uniformLocation(program, "u_clip"), 1, GL_FALSE, glm::value_ptr(clip));
            for (const bool far : {false, true}) {
                if (frame.compare == (far ? Compare::kLess : Compare::kGreater)) {
                    continue;
                }
                const GLfloat farthest = far ? 0.0F : 1.0F;
                glClearBufferfv(GL_DEPTH, 0, &farthest);
                glDepthFunc(far ? GL_GREATER : GL_LESS);
                if (frame.compare == Compare::kBoth) {
                    glColorMask(!far, far, !far, far);
                }
                glDrawElements(GL_TRIANGLES, corners_, GL_UNSIGNED_INT, nullptr);
            }
            glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        }
    }

  private:
    static void clear(const DepthMapFrame& frame) {
        const GLuint words[4] = {};
        const GLfloat floats[4] = {};
        isFrontBack(frame.format) ? glClearBufferuiv(GL_COLOR, 0, words)
                                  : glClearBufferfv(GL_COLOR, 0, floats);
    }

    static glm::mat4 orthographic(const DepthMapFrame& frame) {
        glm::dmat4 clip(0.0);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 row = 2.0 * frame.axis[k] / glm::dot(frame.axis[k], frame.axis[k]);
            for (int i = 0; i < 3; ++i) {
                clip[i][k] = row[i];
            }
            clip[3][k] = -glm::dot(row, frame.origin) - 1.0;
        }
        clip[3][3] = 1.0;
        return glm::mat4(clip);
    }

    /// A near plane at 1/1000 of the volume: the bare draw may leave out what lies nearer.
    static glm::mat4 perspective(const DepthMapFrame& frame, std::uint32_t face) {
        constexpr double kNear = 1e-3;
        constexpr double kFar = 1.8;
        const std::array<std::array<glm::dvec3, 3>, 6> axes = {{{{{0, 0, -1}, {0, -1, 0}, {1, 0, 0}}},
                                                                {{{0, 0, 1}, {0, -1, 0}, {-1, 0, 0}}},
                                                                {{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}},
                                                                {{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}},
                                                                {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}},
                                                                {{{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}}}};
        glm::dmat4 clip(0.0);
        const auto setRow = [&](int k, const glm::dvec3& axis, double factor, double offset) {
            glm::dvec3 row(0.0);
            for (int i = 0; i < 3; ++i) {
                row += factor * axis[i] * frame.axis[i] / glm::dot(frame.axis[i], frame.axis[i]);
            }
            for (int i = 0; i < 3; ++i) {
                clip[i][k] = row[i];
            }
            clip[3][k] = offset - glm::dot(row, frame.origin);
        };
        setRow(0, axes[face][0], 1.0, 0.0);
        setRow(1, axes[face][1], 1.0, 0.0);
        setRow(2, axes[face][2], (kFar + kNear) / (kFar - kNear), -2.0 * kFar * kNear / (kFar - kNear));
        setRow(3, axes[face][2], 1.0, 0.0);
        return glm::mat4(clip);
    }

    GlProgram program_[2];
    GlBuffer positions_;
    GlBuffer triangles_;
    GlVertexArray array_;
    GLsizei corners_ = 0;
};

/// One row of the paper's table of generation times.
struct MapSet {
    const char* name;
    MapFormat format;
    Compare compare;
    int views;  ///< along x, y and z in turn
};
constexpr MapSet kSets[] = {{"float", MapFormat::kFloat32, Compare::kLess, 1},
                            {"fixed8", MapFormat::kFixed8, Compare::kLess, 1},
                            {"front-back half", MapFormat::kFrontBackHalf, Compare::kBoth, 1},
                            {"front-back unorm16", MapFormat::kFrontBackFixed, Compare::kBoth, 1},
                            {"cube", MapFormat::kCube8, Compare::kGreater, 1},
                            {"three front-back unorm16", MapFormat::kFrontBackFixed, Compare::kBoth, 3}};

double ratio(double ours, double bare) {
    return bare > 0.0 ? ours / bare : 0.0;
}

Result<Json> benchSet(const MapSet& set, Decode decode, const PictureMesh& mesh, const BareMesh& bare,
                      GpuMesh& gpu_mesh, DepthMapRenderer& renderer) {
    Bounds box;
    for (const glm::vec3& p : mesh.positions) {
        box.add(p);
    }
    std::vector<DepthMapFrame> frames;
    std::vector<DepthMapTarget> targets;
    for (int view = 0; view < set.views; ++view) {
        frames.push_back(frameFor(box, set.format, set.compare, decode, view));
        auto target = RELIEF_TRY(DepthMapTarget::create(frames.back()));
        targets.push_back(std::move(target));
    }
    Result<void> done;
    const auto render = [&] {
        for (std::size_t i = 0; i < frames.size() && done; ++i) {
            done = renderer.render(gpu_mesh, frames[i], targets[i]);
        }
    };
    const Times bare_times = measure([&] {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            bare.draw(frames[i], targets[i]);
        }
    });
    const Times still = measure(render);
    const Times moved = measure(render, [&] { done = done ? gpu_mesh.setPositions(mesh.positions) : done; });
    for (DepthMapFrame& frame : frames) {
        frame.exact = true;
    }
    const Times exact = measure(render);
    if (!done) {
        return forward(done);
    }
    return Json{{"maps", set.name},
                {"decode", decodeName(decode)},
                {"bare_gpu_ms", bare_times.gpu_ms},
                {"gpu_ms", still.gpu_ms},
                {"gpu_ratio", ratio(still.gpu_ms, bare_times.gpu_ms)},
                {"with_planes_gpu_ms", moved.gpu_ms},
                {"exact_gpu_ms", exact.gpu_ms},
                {"bare_wall_ms", bare_times.wall_ms},
                {"wall_ms", still.wall_ms},
                {"wall_ratio", ratio(still.wall_ms, bare_times.wall_ms)},
                {"with_planes_wall_ms", moved.wall_ms},
                {"exact_wall_ms", exact.wall_ms}};
}

Result<Json> bench(const char* path) {
    const auto context = RELIEF_TRY(GlContext::create());
    const auto mesh = RELIEF_TRY(loadPictureMesh(path));
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    auto gpu_mesh = GpuMesh::create(mesh.positions, triangles);
    auto renderer = DepthMapRenderer::create();
    const auto bare = BareMesh::create(mesh);
    if (!gpu_mesh || !renderer || !bare) {
        return fail(ErrorCode::kFailure, !gpu_mesh ? gpu_mesh.error().message : "a program does not compile");
    }
    Json json{{"device", context->description()},
              {"triangles", triangles.size()},
              {"vertices", mesh.positions.size()},
              {"slots", gpu_mesh->slotCount()},
              {"size", kSize},
              {"sets", Json::array()}};
    for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
        for (const MapSet& set : kSets) {
            auto row = RELIEF_TRY(benchSet(set, decode, mesh, *bare, *gpu_mesh, *renderer));
            json["sets"].push_back(std::move(row));
        }
    }
    return json;
}

Result<Json> bench(int argc, char** argv) {
    return argc == 2 ? bench(argv[1])
                     : fail(ErrorCode::kUsage, "usage: relief-bench-depth-maps MESH (.obj or .ply)");
}

}  // namespace
}  // namespace relief

int main(int argc, char** argv) {
    return relief::finishBench("relief-bench-depth-maps", relief::bench(argc, argv));
}
