// Depth maps of a mesh, and a collider that deforms.
#include <array>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <memory>

#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/collider/deform_pass.h"
#include "runtime/collider/live_collider.h"
#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/files/mesh_file.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"

namespace relief {
namespace {

constexpr std::uint32_t kSize = 512;

Bounds boundsOf(const PictureMesh& mesh) {
    Bounds box;
    for (const glm::vec3& p : mesh.positions) {
        box.add(p);
    }
    return box;
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

/// A bare draw of the same triangles into the same targets: the same indices over plain positions, one colour, the depth
/// test, as many draws and clears.
class BareMesh {
  public:
    static Result<BareMesh> create(const PictureMesh& mesh) {
        BareMesh bare;
        for (int words = 0; words < 2; ++words) {
            bare.program_[words] = RELIEF_TRY(makeProgram("bench/bare_draw.vert", "bench/bare_draw.frag",
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
            const glm::mat4 clip = clipOf(frame, faces == 1 ? -1 : static_cast<int>(face));
            program.set("u_clip", clip);
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

    /// \param face  of the cube; -1: the frame is orthographic.
    static glm::mat4 clipOf(const DepthMapFrame& frame, int face) {
        const glm::dmat4 to_frame =
            glm::inverse(glm::dmat4(glm::dvec4(frame.axis[0], 0.0), glm::dvec4(frame.axis[1], 0.0),
                                    glm::dvec4(frame.axis[2], 0.0), glm::dvec4(frame.origin, 1.0)));
        if (face < 0) {  // from 0…1 to -1…1
            return glm::mat4(glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(-1.0)), glm::dvec3(2.0)) *
                             to_frame);
        }
        // A near plane at 1/1000 of the volume: the bare draw may leave out what lies nearer.
        const glm::dmat4 lens = glm::perspectiveRH_NO(glm::radians(90.0), 1.0, 1e-3, 1.8);
        glm::dvec3 forward(0.0);
        forward[face / 2] = face % 2 == 0 ? 1.0 : -1.0;
        const glm::dvec3 up = face / 2 == 1 ? glm::dvec3(0.0, 0.0, forward.y) : glm::dvec3(0.0, -1.0, 0.0);
        return glm::mat4(lens * glm::lookAtRH(glm::dvec3(0.0), forward, up) * to_frame);
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

Result<Json> benchSet(const Bench& bench, const MapSet& set, Decode decode, const PictureMesh& mesh,
                      const BareMesh& bare, GpuMesh& gpu_mesh, DepthMapRenderer& renderer) {
    std::vector<DepthMapFrame> frames;
    std::vector<DepthMapTarget> targets;
    for (int view = 0; view < set.views; ++view) {
        frames.push_back(frameFor(boundsOf(mesh), set.format, set.compare, decode, view));
        targets.push_back(RELIEF_TRY(DepthMapTarget::create(frames.back())));
    }
    const auto render = [&](bool exact) -> Result<void> {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            frames[i].exact = exact;
            RELIEF_TRY(renderer.render(gpu_mesh, frames[i], targets[i]));
        }
        return {};
    };
    const auto bareDraw = [&]() -> Result<void> {
        for (std::size_t i = 0; i < frames.size(); ++i) {
            bare.draw(frames[i], targets[i]);
        }
        return {};
    };
    const std::vector<Work> works{{"bare", bareDraw},
                                  {"maps", [&] { return render(false); }, "bare"},
                                  {"with planes", [&] { return render(false); }, "bare",
                                   [&] { (void)gpu_mesh.setPositions(mesh.positions); }},
                                  {"exact", [&] { return render(true); }, "bare"}};
    return timeInTurns(bench, works, {.rounds = bench.software ? 9 : 50, .calls = 1, .gpu_clock = true});
}

/// A twist about the upright through the mesh's middle.
Deformation twistOf(const PictureMesh& mesh) {
    const Bounds bounds = boundsOf(mesh);
    Deformation twist;
    twist.amplitude = 0.3F;
    twist.center = bounds.center();
    twist.range_low = bounds.min.y - twist.center.y;
    twist.range_high = bounds.max.y - twist.center.y;
    return twist;
}

}  // namespace

/// Whole sets of maps; `with planes`: the positions have changed before, their upload excluded.
Result<Json> benchDepthMaps(const Bench& bench) {
    const auto mesh = RELIEF_TRY(loadPictureMesh(bench.options.file));
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    auto gpu_mesh = RELIEF_TRY(GpuMesh::create(mesh.positions, triangles));
    auto renderer = RELIEF_TRY(DepthMapRenderer::create());
    const auto bare = RELIEF_TRY(BareMesh::create(mesh));
    Json tables = Json::array();
    for (const Decode decode : {Decode::kProjected, Decode::kPlane}) {
        for (const MapSet& set : kSets) {
            tables.push_back(
                {{"maps", set.name},
                 {"decode", decodeName(decode)},
                 {"triangles", triangles.size()},
                 {"size", kSize},
                 {"rows", RELIEF_TRY(benchSet(bench, set, decode, mesh, bare, gpu_mesh, renderer))}});
        }
    }
    return tables;
}

/// A twist moves the mesh; its three front-back maps of 256² are rendered before each step.
Result<Json> benchLive(const Bench& bench) {
    const auto file = RELIEF_TRY(loadPictureMesh(bench.options.file));
    const PictureMesh mesh = withNormals(file, 4.0F);
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    const Deformation twist = twistOf(mesh);
    auto frames = RELIEF_TRY(liveFrames(deformedBounds(twist, mesh.positions)));
    auto live = RELIEF_TRY(LiveCollider::create(mesh.positions, triangles, frames));
    auto pass = RELIEF_TRY(DeformPass::create(twist, mesh.positions, mesh.normals));
    auto gpu_mesh = RELIEF_TRY(GpuMesh::create(mesh.positions, triangles, {.keep_previous = true}));
    ColliderBody body;
    body.collider = &live.frames();
    body.live = true;
    auto textures = RELIEF_TRY(ColliderTextures::create({&body, 1}));
    Json tables = Json::array();
    for (const std::uint32_t count : bench.particlesOr({1U << 18})) {
        BenchScene scene = makeBenchScene(live.frames(), count);
        scene.liveForever();
        scene.path = bench.options.path;
        auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = scene.path}));
        RELIEF_TRY(particles.setCollider(&textures));
        RELIEF_TRY(particles.setForces(scene.forces));
        particles.spawn(scene.births);
        double time = 0.0;
        const auto deform = [&]() -> Result<void> {
            pass.run(time += kBenchDt);
            return {};
        };
        const auto update = [&]() -> Result<void> {
            RELIEF_TRY(live.setPositions(pass.buffer().name()));
            return live.update(textures, 0);
        };
        const auto step = [&]() -> Result<void> {
            particles.step(kBenchDt);
            return {};
        };
        const std::vector<Work> works{
            {"deform", deform},
            {"positions", [&] { return gpu_mesh.setPositions(pass.buffer().name()); }},
            {"update", update},
            {"step", step},
            {"all", [&]() -> Result<void> {
                 RELIEF_TRY(deform());
                 RELIEF_TRY(update());
                 return step();
             }}};
        tables.push_back({{"triangles", triangles.size()},
                          {"particles", count},
                          {"rows", RELIEF_TRY(timeInTurns(bench, works, {.rounds = 9}))}});
    }
    return tables;
}

}  // namespace relief
