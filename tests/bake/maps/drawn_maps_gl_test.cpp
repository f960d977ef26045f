// SPDX-License-Identifier: Apache-2.0
// Front-back plane maps drawn by DepthMapRenderer, compared with baked maps of real meshes. The two programs share the
// view and the texel format, but no arithmetic. Also patches beside other maps, on the GPU and the CPU.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "bake/import/mesh_import.h"
#include "bake/maps/bake_maps.h"
#include "bake/repair/hole_caps.h"
#include "bake/views/view.h"
#include "formats/plane.h"
#include "runtime/depth_maps/gpu_mesh.h"
#include "runtime/gl/gl_context.h"
#include "tests/bake/meshes.h"
#include "tests/runtime/collider/field_agreement.h"
#include "tests/runtime/depth_maps/read_texels.h"
#include "tests/runtime/gl/gl_test.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// In texels. Only within this distance from a triangle edge may one program find a surface and the other none:
/// rasterisers snap vertices to 1/256 texel.
constexpr double kEdge = 0.01;
constexpr double kShare = 1e-3;  // fraction of texels whose depths may differ by more than one code

constexpr const char* kFormats[] = {"front-back:dir=-x", "front-back:dir=1/2/3"};

/// The meshes of libcgal-demo, unpacked once.
const fs::path& cgalMeshes() {
    static const TemporaryFolder folder;
    static const fs::path meshes = [] {
        const std::string command =
            "tar -xzf /usr/share/doc/libcgal-dev/data.tar.gz -C '" + folder.path().string() + "' data/meshes";
        EXPECT_EQ(std::system(command.c_str()), 0) << "Debian package libcgal-demo";
        return folder.path() / "data" / "meshes";
    }();
    return meshes;
}

TriangleMesh load(const std::string& name) {
    const fs::path path = name.find('/') != std::string::npos ? fs::path(name) : cgalMeshes() / name;
    return *required(closeHoles(required(importMesh(path))));
}

MapSpec specOf(const TriangleMesh& mesh, const std::string& text) {
    return required(completeSpec(*parseMapSpec(text), mesh, 256));
}

DepthMap drawOne(const PreparedMesh& mesh, const MapSpec& spec) {
    const View view = *makeView(spec, *mesh);
    DepthMap map = view.emptyMap();
    map.decode = spec.decode;
    GpuMesh on_gpu = required(GpuMesh::create(mesh->positions, mesh->triangles));
    const DepthMapRenderer renderer = required(DepthMapRenderer::create(map.width, map.height));
    renderer.render(on_gpu, map);
    map.texels = readTexels(renderer);
    return map;
}

/// One end of a texel: 0 is the front, 1 the back.
struct TexelEnd {
    std::uint32_t x;
    std::uint32_t y;
    int end;
};

std::optional<Surface> surfaceAt(const DepthMap& map, const TexelEnd& at) {
    const Texel texel = decodeTexel(map.format, map.texelAt(0, at.x, at.y));
    return at.end == 0 ? texel.front : texel.back;
}

/// Differences between two maps with the same view.
struct Agreement {
    std::uint64_t both = 0;          ///< surfaces in both maps
    std::vector<TexelEnd> depths;    ///< in both maps, but the depths differ by more than one code
    std::vector<TexelEnd> coverage;  ///< in only one map
};

Agreement compareMaps(const DepthMap& a, const DepthMap& b) {
    Agreement agreement;
    for (std::uint32_t i = 0; i < 2 * a.width * a.height; ++i) {
        const TexelEnd at{i / 2 % a.width, i / 2 / a.width, static_cast<int>(i % 2)};
        const std::optional<Surface> of_a = surfaceAt(a, at);
        const std::optional<Surface> of_b = surfaceAt(b, at);
        if (of_a.has_value() != of_b.has_value()) {
            agreement.coverage.push_back(at);
        } else if (of_a) {
            ++agreement.both;
            if (std::abs(of_a->depth - of_b->depth) > 1.5F / 65534.0F) {
                agreement.depths.push_back(at);
            }
        }
    }
    return agreement;
}

/// Distance in texels from a texel's centre to the nearest projected triangle edge.
double edgeDistance(const TriangleMesh& mesh, const View& view, const TexelEnd& at) {
    const glm::dvec2 centre(at.x + 0.5, at.y + 0.5);
    const auto project = [&](std::uint32_t vertex) {
        const glm::dvec3 from = glm::dvec3(mesh.positions[vertex]) - view.origin;
        const auto along = [&](int k) {
            return glm::dot(from, view.axis[k]) / glm::dot(view.axis[k], view.axis[k]);
        };
        return glm::dvec2(along(0) * view.width, along(1) * view.height);
    };
    double nearest = std::numeric_limits<double>::max();
    for (const glm::uvec3& t : mesh.triangles) {
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 from = project(t[i]);
            const glm::dvec2 edge = project(t[(i + 1) % 3]) - from;
            const double square = glm::dot(edge, edge);
            const double share =
                square > 0.0 ? std::clamp(glm::dot(centre - from, edge) / square, 0.0, 1.0) : 0.0;
            nearest = std::min(nearest, glm::length(centre - (from + share * edge)));
        }
    }
    return nearest;
}

/// The parameter is the name of a mesh.
class DrawnMapsGlTest : public testing::TestWithParam<const char*> {
  protected:
    void SetUp() override { context_ = required(GlContext::create()); }
    std::unique_ptr<GlContext> context_;
};

/// Whether a texel's plane is not steep. The ray caster moves steep planes behind neighbouring rays, which the GPU does
/// not examine.
bool isFlat(const DepthMap& map, const TexelEnd& at) {
    const glm::dvec3 ray = texelRay(map, 0, at.x, at.y).direction;
    return std::abs(glm::dot(glm::dvec3(surfaceAt(map, at)->normal), ray)) / glm::length(ray) > 0.36;
}

TEST_P(DrawnMapsGlTest, MatchMapsWithOneRayPerTexel) {
    const TriangleMesh mesh = load(GetParam());
    for (const char* text : kFormats) {
        SCOPED_TRACE(text);
        const MapSpec spec = specOf(mesh, text);
        const View view = *makeView(spec, mesh);
        const DepthMap drawn = drawOne(mesh, spec);
        const DepthMap rays = bakeMaps(mesh, {spec}, Quality::kFast).maps.front();
        ASSERT_EQ(drawn.decode, Decode::kPlane);
        const Agreement agreement = compareMaps(drawn, rays);
        ASSERT_GT(agreement.both, 10000U);
        std::uint64_t flat = 0;
        for (const TexelEnd& at : agreement.depths) {
            flat += isFlat(drawn, at) && isFlat(rays, at) ? 1 : 0;
        }
        EXPECT_LE(static_cast<double>(flat), std::max(2.0, kShare * static_cast<double>(agreement.both)));
        EXPECT_LE(static_cast<double>(agreement.depths.size()), 0.01 * static_cast<double>(agreement.both));
        // The ray caster also finds walls at silhouettes between texel centres. Surfaces only in the GPU map must lie
        // at an edge.
        std::uint64_t checked = 0;
        for (const TexelEnd& at : agreement.coverage) {
            if (surfaceAt(drawn, at) && checked++ < 10) {
                EXPECT_LT(edgeDistance(mesh, view, at), kEdge)
                    << "texel (" << at.x << ", " << at.y << "), end " << at.end;
            }
        }
    }
}

std::string meshName(const testing::TestParamInfo<const char*>& info) {
    std::string name;
    for (const char c : fs::path(info.param).filename().string()) {
        name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
    }
    return name;
}

INSTANTIATE_TEST_SUITE_P(Meshes, DrawnMapsGlTest,
                         testing::Values("/usr/share/glmark2/models/bunny.obj", "camel.off", "fandisk.off",
                                         "anchor_dense.off", "cheese.off", "knot2.off", "man.off",
                                         "refined_elephant.off", "lion-head.off", "elephant.off",
                                         "/usr/share/assimp/models/OBJ/spider.obj",
                                         "/usr/share/assimp/models/PLY/Wuson.ply"),
                         meshName);

class HybridGlTest : public GlTest {};

TEST_P(HybridGlTest, PatchesBesideOtherMapsMatchTheCpu) {
    const glm::dmat3 turn = rotation({1, 2, 3}, 40.0);
    const TriangleMesh mesh = joined({makeTorusMesh(1.0, 0.35, 96, 48), makeIcosphere({0, 0, 0.9}, 0.3, 4),
                                      makeBoxMesh({0.1, 0.2, -0.9}, {0.9, 0.3, 0.2}, turn)});
    const std::vector<std::vector<std::string>> bakes = {
        {"patches:budget=60kB", "front-back:dir=-z,size=64"},
        {"cube:size=32", "patches:budget=200kB"},
        {"front-back:dir=-x,size=48,decode=plane", "patches:budget=100kB", "cube:size=24,decode=plane",
         "fixed8:dir=0.3/-1/0.2,size=40"},
    };
    for (const std::vector<std::string>& specs : bakes) {
        SCOPED_TRACE(specs[0]);
        const Collider collider = bakeSpecs(mesh, specs);
        std::mt19937 random(3);
        std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
        std::vector<glm::vec3> points(100'000);
        for (glm::vec3& p : points) {
            p = 1.1F * glm::vec3(1.4F * unit(random), 1.4F * unit(random), 1.3F * unit(random));
        }
        expectAgreement(collider, points, 1.0F / 60.0F, 5e-3);
    }
}

RELIEF_INSTANTIATE_GL_TESTS(HybridGlTest);

}  // namespace
}  // namespace relief::test
