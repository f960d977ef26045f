// SPDX-License-Identifier: Apache-2.0
// The whole pipeline on a real mesh: determinism, provenance, round trips and known sides.
#include <algorithm>
#include <atomic>

#include "bake/import/mesh_import.h"
#include "bake/measure/accuracy.h"
#include "bake/mesh/mesh_query.h"
#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "tests/bake/meshes.h"

namespace relief::test {
namespace {

constexpr const char* kBunny = "/usr/share/glmark2/models/bunny.obj";

const TriangleMesh& bunny() {
    static const TriangleMesh mesh = required(importMesh(kBunny));  // Debian package glmark2-data
    return mesh;
}

const std::vector<std::string> kAllFormats = {
    "front-back:dir=-x", "front-back:dir=1/2/3", "fixed8:dir=-y", "float:dir=+z,compare=greater", "cube",
    "cube:center=0/5/0"};

/// Expects the same bytes with one thread, with two, and with more threads than cores.
void expectSameOnThreads(const TriangleMesh& mesh, const std::vector<std::string>& specs) {
    const std::vector<std::byte> one = *writeContainer(bakeSpecs(mesh, specs, 96, 1));
    for (const unsigned threads : {2U, 7U}) {
        EXPECT_TRUE(one == *writeContainer(bakeSpecs(mesh, specs, 96, threads))) << threads << " threads";
    }
}

TEST(BakeBunny, IsDeterministic) {
    expectSameOnThreads(bunny(), kAllFormats);
    expectSameOnThreads(
        makeTorusMesh(1.0, 0.4, 48, 24),
        {"front-back:dir=1/2/3,decode=plane", "cube:size=24,decode=plane", "fixed8:decode=plane"});
}

TEST(BakeTies, AreDeterministic) {
    // Triangle edges on texel centres, and every triangle duplicated and reversed: ties everywhere.
    TriangleMesh mesh = makePlane(0.0F, 60);
    for (std::size_t i = 0, n = mesh.triangles.size(); i < n; ++i) {
        const glm::uvec3 t = mesh.triangles[i];
        mesh.triangles.emplace_back(t.x, t.z, t.y);
    }
    const std::vector<std::string> specs = {"float:dir=-y,size=62,box=-1/-1/-1/1/1/1",
                                            "fixed8:dir=-y,size=61x122",
                                            "front-back:dir=+y,size=62,box=-1/-1/-1/1/1/1"};
    expectSameOnThreads(mesh, specs);
}

TEST(BakeBunny, RoundTripsWithProvenance) {
    const Collider collider = bakeSpecs(bunny(), kAllFormats, 32);
    const Collider back = required(readContainer(required(writeContainer(collider))));
    EXPECT_TRUE(back == collider);
    EXPECT_EQ(back.provenance.mesh_name, "bunny.obj");
    EXPECT_EQ(back.provenance.mesh_hash, bunny().content_hash);
    EXPECT_EQ(back.provenance.triangles, 69666U);
    // Baking with the recorded options gives the same maps.
    std::vector<std::string> specs;
    for (const RecordedOption& option : back.provenance.options) {
        if (option.name == "map") {
            specs.push_back(option.value);
        }
    }
    ASSERT_EQ(specs.size(), kAllFormats.size());
    EXPECT_EQ(specs[0], "front-back:dir=-x,size=32x32,depth=half,decode=projected,box=tight");
    EXPECT_EQ(specs.back(), "cube:size=32,compare=less,center=0/5/0,decode=projected,box=tight");
    EXPECT_TRUE(bakeSpecs(bunny(), specs, 999).maps == collider.maps);
}

TEST(BakeBunny, DefaultMapsClassifyPoints) {
    const Baked baked =
        required(bake(bunny(), {.maps = {}, .resolution = 256, .threads = 0, .progress = {}}));
    ASSERT_EQ(baked.collider.maps.size(), 4U);
    EXPECT_EQ(baked.collider.maps[3].compare, Compare::kGreater);
    const TruthSamples truth = sampleTruth(queryOf(bunny()), {.samples = 2000});
    EXPECT_GT(std::ranges::count_if(truth.uniform, &TruthPoint::inside), 400);
    EXPECT_LE(measureField(truth, fieldOf(baked.collider)).uniform.total(), 2.0)
        << "only concavities that no map sees are wrongly inside";
}

/// The search on three maps of planes, at 0.5 % of the longest side from the surface (one texel) and at 5 %.
TEST(BakeBunny, NearestSurfaceIsTheNearestTriangle) {
    const MeshQuery query = queryOf(bunny());
    const Collider collider = bakeSpecs(
        query.prepared(),
        {"front-back:dir=-x,decode=plane,depth=unorm16", "front-back:dir=-y,decode=plane,depth=unorm16",
         "front-back:dir=-z,decode=plane,depth=unorm16"},
        240);
    for (const double sigma : {0.005, 0.05}) {
        const TruthSamples samples = sampleTruth(query, {.samples = 20'000, .sigma_share = sigma});
        const double off = sigma * samples.longest_side;
        const FieldAccuracy votes = measureField(samples, fieldOf(collider));
        const FieldAccuracy found = measureField(samples, nearestFieldOf(collider));
        EXPECT_EQ(found.near.total(), votes.near.total());
        EXPECT_EQ(found.far_percent, 0.0);
        EXPECT_LT(found.distance_mean, 0.05 * off) << "of " << off;
        EXPECT_LT(found.distance_p99, 0.5 * off);
        int astray = 0;
        for (const TruthPoint& point : samples.near) {
            const SurfaceSample nearest = nearestSurface(collider, point.position);
            // The point found is on the mesh. Deep inside, another surface can be equally near.
            if (std::abs(double{nearest.distance} - double{point.distance}) < 0.01 * off) {
                const double from_mesh = query.closest(nearest.point).distance;
                ASSERT_LT(from_mesh, 0.2 * off);
                astray += from_mesh > 0.1 * off ? 1 : 0;
            }
        }
        EXPECT_LT(astray, 10) << "out of 20,000";
    }
}

TEST(BakeProgress, RunsFromZeroToOne) {
    for (const char* decode : {"projected", "plane"}) {
        double last = 0.0;
        std::atomic<int> within = 0;
        BakeOptions options;
        for (const char* direction : {"-x", "-y", "-z"}) {
            options.maps.push_back(*parseMapSpec(std::string("front-back:size=130,depth=unorm16,dir=") +
                                                 direction + ",decode=" + decode));
        }
        options.progress = [&](double share) {
            EXPECT_EQ(++within, 1);  // called by one thread at a time
            EXPECT_GT(share, last);
            last = share;
            --within;
        };
        ASSERT_TRUE(bake(makeBoxMesh({0, 0, 0}, {1, 1, 1}), options));
        EXPECT_EQ(last, 1.0);
    }
}

}  // namespace
}  // namespace relief::test
