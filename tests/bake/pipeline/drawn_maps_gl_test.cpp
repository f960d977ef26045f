// Maps that DepthMapRenderer draws against baked ones, on real meshes: two programs that share the view and the
// meaning of a texel, and no arithmetic.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>

#include "bake/import/mesh_import.h"
#include "bake/pipeline/bake.h"
#include "bake/repair/hole_caps.h"
#include "formats/plane.h"
#include "runtime/depth_maps/depth_map_renderer.h"
#include "runtime/depth_maps/gpu_mesh.h"
#include "runtime/gl/gl_context.h"
#include "tests/bake/meshes.h"
#include "tests/bake/pipeline/map_agreement.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

/// Only where a texel's centre lies so near to an edge of a triangle, in texels, may one program see a surface and the
/// other none: rasterisers move vertices to a grid of 1/256 texel.
constexpr double kEdge = 0.01;
constexpr double kShare = 1e-3;  // of the texels whose depths may differ by more than a unit
/// A best index is at most 0.65 degrees off, so that two of one surface are at most twice that apart.
constexpr double kDegrees = 1.3;

constexpr const char* kFormats[] = {"float:dir=-z,decode=projected",
                                    "fixed8:dir=-y,compare=greater,decode=projected",
                                    "front-back:dir=1/2/3,depth=half,decode=projected",
                                    "front-back:dir=-x,decode=projected", "cube:size=128,decode=projected"};
constexpr const char* kPlaneFormats[] = {"float:dir=-z", "fixed8:dir=-y,compare=greater",
                                         "front-back:dir=1/2/3,depth=half", "front-back:dir=-x",
                                         "cube:size=128"};

/// The meshes of libcgal-demo and the documents of libcgal-dev, unpacked once.
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
    Result<TriangleMesh> mesh = importMesh(path);
    const Result<PreparedMesh> closed = mesh ? closeHoles(std::move(*mesh)) : forward(mesh);
    if (!closed) {
        ADD_FAILURE() << closed.error().message;
        std::abort();
    }
    return **closed;
}

MapSpec specOf(const TriangleMesh& mesh, const std::string& text) {
    const Result<MapSpec> spec = completeSpec(*parseMapSpec(text), mesh, 256);
    EXPECT_TRUE(spec) << spec.error().message;
    return *spec;
}

DepthMap drawOne(const PreparedMesh& mesh, const MapSpec& spec) {
    const View view = *makeView(spec, *mesh);
    DepthMapFrame frame;
    frame.format = view.format;
    frame.compare = view.compare;
    frame.decode = spec.decode;
    frame.width = view.width;
    frame.height = view.height;
    frame.origin = view.origin;
    std::copy(std::begin(view.axis), std::end(view.axis), std::begin(frame.axis));
    frame.encloses = view.encloses;
    std::copy(std::begin(view.starts_free), std::end(view.starts_free), std::begin(frame.starts_free));
    DepthMap map = view.emptyMap();
    map.decode = spec.decode;
    Result<GpuMesh> on_gpu = GpuMesh::create(mesh->positions, mesh->triangles);
    Result<DepthMapRenderer> renderer = DepthMapRenderer::create();
    const Result<DepthMapTarget> target = DepthMapTarget::create(frame);
    if (!on_gpu || !renderer || !target || !renderer->render(*on_gpu, frame, *target) ||
        !target->read(0, 0, target->width(), target->height(), map.texels)) {
        ADD_FAILURE() << "the map cannot be drawn";
        std::abort();
    }
    return map;
}

DepthMap bakeOne(const PreparedMesh& mesh, const MapSpec& spec) {
    BakeOptions options;
    options.maps = {spec};
    options.quality = Quality::kFast;
    const Result<Baked> baked = bake(mesh, options);
    if (!baked) {
        ADD_FAILURE() << baked.error().message;
        std::abort();
    }
    return baked->collider.maps.front();
}

std::string where(const Disagreement& at) {
    return "face " + std::to_string(at.face) + ", texel (" + std::to_string(at.x) + ", " +
           std::to_string(at.y) + "), end " + std::to_string(at.end);
}

class DrawnOddMapsGlTest : public testing::Test {
  protected:
    void SetUp() override {
        auto context = GlContext::create();
        ASSERT_TRUE(context) << context.error().message;
        context_ = std::move(*context);
    }
    std::unique_ptr<GlContext> context_;
};

/// Of a mesh by its name.
class DrawnMapsGlTest : public DrawnOddMapsGlTest, public testing::WithParamInterface<const char*> {};

TEST_P(DrawnMapsGlTest, TheirTexelsAreThoseOfRaysToAUnit) {
    const TriangleMesh mesh = load(GetParam());
    std::uint64_t both_all = 0;
    std::uint64_t normals_off = 0;
    for (const char* text : kFormats) {
        SCOPED_TRACE(text);
        const MapSpec spec = specOf(mesh, text);
        const View view = *makeView(spec, mesh);
        const DepthMap drawn = drawOne(mesh, spec);
        const DepthMap rays = bakeOne(mesh, spec);
        ASSERT_EQ(drawn.texels.size(), rays.texels.size());
        EXPECT_EQ(drawn.empty_is_outside, rays.empty_is_outside);
        const Agreement agreement = compareMaps(drawn, rays, kDegrees);
        ASSERT_GT(agreement.both, 10000U) << "the map shows next to nothing";
        // A texel on an edge may differ in any map: two of a small map are more than their share.
        const double allowed = std::max(2.0, kShare * static_cast<double>(agreement.both));
        EXPECT_LE(static_cast<double>(agreement.depths.size()), allowed);
        EXPECT_LE(static_cast<double>(agreement.coverage.size()), allowed);
        for (const Disagreement& at : agreement.coverage) {
            EXPECT_LT(edgeDistance(mesh, view, at.face, at.x, at.y), kEdge) << where(at);
        }
        // A float map's unit is finer than its rounding where the surface is steep: never two.
        for (const Disagreement& at : agreement.depths) {
            if (at.units > 2.0) {
                EXPECT_LT(edgeDistance(mesh, view, at.face, at.x, at.y), kEdge) << where(at);
            }
        }
        both_all += agreement.both;
        normals_off += agreement.normals_off;
    }
    // Beside an edge the ray caster takes the triangle that faces it most, the GPU the one that it finds
    // there.
    EXPECT_LE(static_cast<double>(normals_off), 2e-3 * static_cast<double>(both_all));
}

/// Texels whose plane is neither steep nor standing in both maps: the ray caster moves others behind the rays
/// next to them, which the GPU does not look at.
bool isFlat(const DepthMap& map, const Disagreement& at) {
    const Texel texel = decodeTexel(map.format, map.texelAt(at.face, at.x, at.y));
    const std::optional<Surface>& surface = at.end == 0 ? texel.front : texel.back;
    const glm::dvec3 ray = texelRay(map, at.face, at.x, at.y).direction;
    return surface && std::abs(glm::dot(glm::dvec3(surface->normal), ray)) / glm::length(ray) > 0.36;
}

class DrawnPlanesGlTest : public DrawnMapsGlTest {};

TEST_P(DrawnPlanesGlTest, TheyAreThoseOfOneRayATexel) {
    const TriangleMesh mesh = load(GetParam());
    for (const char* text : kPlaneFormats) {
        SCOPED_TRACE(text);
        const MapSpec spec = specOf(mesh, text);
        const View view = *makeView(spec, mesh);
        const DepthMap drawn = drawOne(mesh, spec);
        const DepthMap rays = bakeOne(mesh, spec);
        ASSERT_EQ(drawn.decode, Decode::kPlane);
        const Agreement agreement = compareMaps(drawn, rays, kDegrees);
        ASSERT_GT(agreement.both, 10000U);
        std::uint64_t flat = 0;
        for (const Disagreement& at : agreement.depths) {
            flat += isFlat(drawn, at) && isFlat(rays, at) ? 1 : 0;
        }
        EXPECT_LE(static_cast<double>(flat), std::max(2.0, kShare * static_cast<double>(agreement.both)));
        EXPECT_LE(static_cast<double>(agreement.depths.size()), 0.01 * static_cast<double>(agreement.both));
        // The ray caster looks for silhouettes between texels' centres, and stores walls where it finds them:
        // what the GPU alone has lies on an edge.
        std::uint64_t checked = 0;
        for (const Disagreement& at : agreement.coverage) {
            const Texel texel = decodeTexel(drawn.format, drawn.texelAt(at.face, at.x, at.y));
            if ((at.end == 0 ? texel.front : texel.back) && checked++ < 10) {
                EXPECT_LT(edgeDistance(mesh, view, at.face, at.x, at.y), kEdge) << where(at);
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

INSTANTIATE_TEST_SUITE_P(Meshes, DrawnPlanesGlTest,
                         testing::Values("/usr/share/glmark2/models/bunny.obj", "fandisk.off",
                                         "refined_elephant.off", "lion-head.off",
                                         "/usr/share/assimp/models/OBJ/spider.obj"),
                         meshName);

// What closed meshes in tight boxes do not show: boxes that cut through the mesh, rays that start inside,
// meshes that are inside out, far from the origin, or of other sizes.
TEST_F(DrawnOddMapsGlTest, CutAndOddMeshesAgreeToo) {
    const TriangleMesh sphere = makeIcosphere({0.1, 0.2, -0.3}, 1.0, 5);
    TriangleMesh far_away = sphere;
    for (glm::vec3& p : far_away.positions) {
        p = 1e-6F * p + glm::vec3(3e-4F, 0.0F, -5e-4F);
    }
    far_away = finished(far_away.positions, far_away.triangles);
    struct Case {
        const char* what;
        TriangleMesh mesh;
        const char* spec;
    };
    const Case cases[] = {
        {"cut", sphere, "front-back:dir=-x,box=-0.3/-0.7/-1.4/0.5/0.6/0.4,decode=projected,size=160"},
        {"cut, planes", sphere, "front-back:dir=-x,box=-0.3/-0.7/-1.4/0.5/0.6/0.4,size=160"},
        {"starts inside", sphere, "fixed8:dir=+z,box=-2/-2/-0.9/2/2/2,decode=projected,size=160"},
        {"cube in the sphere", sphere, "cube:center=0.3/0.2/-0.1,compare=less,decode=projected,size=96"},
        {"cube beside it", sphere, "cube:center=1.5/0.2/-0.1,compare=less,decode=projected,size=96"},
        {"cube, cut", sphere, "cube:box=-0.5/-0.5/-1.2/1.3/1.3/0.5,compare=greater,decode=projected,size=96"},
        {"cube, cut, less", sphere,
         "cube:box=0.8/-0.5/-1.2/1.3/0.4/0.5,compare=less,decode=projected,size=96"},
        {"small and away", far_away, "front-back:dir=1/1/0,decode=projected,size=160"},
        {"long", sphere, "fixed8:dir=-z,decode=projected,size=2100x40"},
    };
    for (const Case& one : cases) {
        SCOPED_TRACE(one.what);
        const MapSpec spec = specOf(one.mesh, one.spec);
        const View view = *makeView(spec, one.mesh);
        const DepthMap drawn = drawOne(one.mesh, spec);
        const DepthMap rays = bakeOne(one.mesh, spec);
        const Agreement agreement = compareMaps(drawn, rays, kDegrees);
        EXPECT_GT(agreement.both, 1000U);
        EXPECT_LE(agreement.normals_off, agreement.both / (spec.decode == Decode::kProjected ? 200 : 20));
        // Off the edges of triangles; on the near plane, too, a clipped triangle ends on the rasteriser's grid.
        std::uint64_t off = 0;
        const auto isOff = [&](const Disagreement& at) {
            return edgeDistance(one.mesh, view, at.face, at.x, at.y) > kEdge;
        };
        for (const Disagreement& at : agreement.depths) {
            // Steep planes are the ray caster's alone, as above.
            const bool counts = spec.decode == Decode::kProjected || (isFlat(drawn, at) && isFlat(rays, at));
            off += counts && isOff(at) ? 1 : 0;
        }
        for (const Disagreement& at : agreement.coverage) {
            const Texel texel = decodeTexel(drawn.format, drawn.texelAt(at.face, at.x, at.y));
            const bool counts =
                spec.decode == Decode::kProjected || (at.end == 0 ? texel.front : texel.back).has_value();
            off += counts && isOff(at) ? 1 : 0;
        }
        EXPECT_LE(off, 2U);
    }
}

}  // namespace
}  // namespace relief::test
