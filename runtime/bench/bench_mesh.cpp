// Depth maps of a mesh, over a bare draw of the same triangles, and a collider that wobbles.
#include <glm/gtc/matrix_transform.hpp>

#include "runtime/bench/bench.h"
#include "runtime/bench/bench_scene.h"
#include "runtime/collider/live_collider.h"
#include "runtime/collider/wobble_pass.h"
#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/files/mesh_file.h"
#include "runtime/gl/gl_functions.h"
#include "runtime/gl/pass_state.h"
#include "runtime/picture/collider_mesh.h"

namespace relief {
namespace {

constexpr std::uint32_t kSize = 512;

/// A view along one axis, round the whole box.
DepthMapFrame frameFor(const Bounds& box, MapFormat format, int along) {
    DepthMapFrame frame;
    frame.format = format;
    frame.compare = isFrontBack(format) ? Compare::kBoth : Compare::kLess;
    frame.decode = Decode::kPlane;
    frame.width = frame.height = kSize;
    const glm::dvec3 size = 1.02 * glm::dvec3(box.max - box.min);
    frame.origin = glm::dvec3(box.center()) - 0.5 * size;
    for (int k = 0; k < 3; ++k) {
        const int of = (along + 1 + k) % 3;
        frame.axis[k] = glm::dvec3(0.0);
        frame.axis[k][of] = size[of];
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
        const auto upload = [](GLenum target, const GlBuffer& buffer, const auto& values) {
            glBindBuffer(target, buffer.name());
            glBufferData(target, static_cast<GLsizeiptr>(values.size() * sizeof(values[0])), values.data(),
                         GL_STATIC_DRAW);
        };
        upload(GL_ARRAY_BUFFER, bare.positions_, mesh.positions);
        upload(GL_ELEMENT_ARRAY_BUFFER, bare.triangles_, mesh.triangles);
        glEnableVertexAttribArray(0);
        glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, nullptr);
        glBindVertexArray(0);
        return bare;
    }

    void draw(const DepthMapFrame& frame, const DepthMapTarget& target) const {
        const PassState state;
        const bool both = isFrontBack(frame.format);
        const GlProgram& program = program_[both ? 1 : 0];
        program.use();
        const glm::dmat4 to_frame =
            glm::inverse(glm::dmat4(glm::dvec4(frame.axis[0], 0.0), glm::dvec4(frame.axis[1], 0.0),
                                    glm::dvec4(frame.axis[2], 0.0), glm::dvec4(frame.origin, 1.0)));
        // From 0…1 to -1…1.
        program.set("u_clip",
                    glm::mat4(glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(-1.0)), glm::dvec3(2.0)) *
                              to_frame));
        glBindVertexArray(array_.name());
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer());
        glEnable(GL_DEPTH_TEST);
        glViewport(0, 0, kSize, kSize);
        const GLuint words[4] = {};
        const GLfloat floats[4] = {};
        both ? glClearBufferuiv(GL_COLOR, 0, words) : glClearBufferfv(GL_COLOR, 0, floats);
        for (int far = 0; far < (both ? 2 : 1); ++far) {
            const GLfloat farthest = far == 1 ? 0.0F : 1.0F;
            glClearBufferfv(GL_DEPTH, 0, &farthest);
            glDepthFunc(far == 1 ? GL_GREATER : GL_LESS);
            if (both) {
                glColorMask(far == 0, far == 1, far == 0, far == 1);
            }
            glDrawElements(GL_TRIANGLES, corners_, GL_UNSIGNED_INT, nullptr);
        }
    }

  private:
    GlProgram program_[2];
    GlBuffer positions_;
    GlBuffer triangles_;
    GlVertexArray array_;
    GLsizei corners_ = 0;
};

/// Whole sets of maps; `with planes`: the positions have changed before, their upload excluded.
Result<Json> benchMaps(const Bench& bench, const PictureMesh& mesh, const Bounds& box) {
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    auto gpu_mesh = RELIEF_TRY(GpuMesh::create(mesh.positions, triangles));
    auto renderer = RELIEF_TRY(DepthMapRenderer::create());
    const auto bare = RELIEF_TRY(BareMesh::create(mesh));
    struct MapSet {
        const char* name;
        MapFormat format;
        int views;  // along x, y and z in turn
    };
    Json tables = Json::array();
    for (const MapSet& set : {MapSet{"float", MapFormat::kFloat32, 1},
                              {"fixed8", MapFormat::kFixed8, 1},
                              {"front-back unorm16", MapFormat::kFrontBackFixed, 1},
                              {"three front-back unorm16", MapFormat::kFrontBackFixed, 3}}) {
        std::vector<DepthMapFrame> frames;
        std::vector<DepthMapTarget> targets;
        for (int view = 0; view < set.views; ++view) {
            frames.push_back(frameFor(box, set.format, view));
            targets.push_back(RELIEF_TRY(DepthMapTarget::create(frames.back())));
        }
        const auto render = [&]() -> Result<void> {
            for (std::size_t i = 0; i < frames.size(); ++i) {
                RELIEF_TRY(renderer.render(gpu_mesh, frames[i], targets[i]));
            }
            return {};
        };
        const auto drawBare = [&]() -> Result<void> {
            for (std::size_t i = 0; i < frames.size(); ++i) {
                bare.draw(frames[i], targets[i]);
            }
            return {};
        };
        const std::vector<Work> works{
            {"bare", drawBare}, {"maps", render, "bare"}, {"with planes", render, "bare", [&] {
                                                               (void)gpu_mesh.setPositions(mesh.positions);
                                                           }}};
        tables.push_back(
            {{"maps", set.name},
             {"triangles", triangles.size()},
             {"size", kSize},
             {"rows",
              RELIEF_TRY(timeInTurns(bench, works,
                                     {.rounds = bench.software ? 9 : 50, .calls = 1, .gpu_clock = true}))}});
    }
    return tables;
}

/// A wobble moves the mesh; its three front-back maps of 256² are rendered before each step.
Result<Json> benchLive(const Bench& bench, const PictureMesh& mesh, Bounds box) {
    const std::vector<glm::uvec3> triangles = trianglesOf(mesh);
    const Wobble wobble{.amplitude = 0.02F * box.longestSide(), .wavelength = 0.5F * box.longestSide()};
    box.min -= wobble.amplitude;
    box.max += wobble.amplitude;
    const Collider frames = RELIEF_TRY(liveFrames(box));
    auto live = RELIEF_TRY(LiveCollider::create(mesh.positions, triangles, frames));
    auto pass = RELIEF_TRY(WobblePass::create(wobble, mesh.positions, mesh.normals));
    ColliderBody body;
    body.collider = &live.frames();
    body.live = true;
    auto textures = RELIEF_TRY(ColliderTextures::create({&body, 1}));
    const std::uint32_t count = bench.particlesOr(1U << 18, 1U << 18);
    const BenchScene scene = makeBenchScene(live.frames(), count);
    auto particles = RELIEF_TRY(ParticleSystem::create({.capacity = count, .path = bench.path}));
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
    const auto all = [&]() -> Result<void> {
        RELIEF_TRY(deform());
        RELIEF_TRY(update());
        return step();
    };
    const std::vector<Work> works{{"deform", deform}, {"update", update}, {"step", step}, {"all", all}};
    return Json{{"maps", "of a collider that deforms"},
                {"triangles", triangles.size()},
                {"particles", count},
                {"rows", RELIEF_TRY(timeInTurns(bench, works, {.rounds = 9}))}};
}

}  // namespace

Result<Json> benchMesh(const Bench& bench) {
    const PictureMesh mesh = withNormals(RELIEF_TRY(loadPictureMesh(bench.file)), 4.0F);
    Bounds box;
    for (const glm::vec3& p : mesh.positions) {
        box.add(p);
    }
    Json tables = RELIEF_TRY(benchMaps(bench, mesh, box));
    tables.push_back(RELIEF_TRY(benchLive(bench, mesh, box)));
    return tables;
}

}  // namespace relief
