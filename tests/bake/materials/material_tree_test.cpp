// SPDX-License-Identifier: Apache-2.0
// Materials at contacts with baked maps of every format, compared with meshes whose material borders have closed forms.
// Trees with too large, undilated or rotated cells are wrong at more than a hundredth of the contacts.
#include "bake/materials/material_tree.h"

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bake/mesh/mesh_query.h"
#include "bake/mesh/surface_sampler.h"
#include "bake/pipeline/bake.h"
#include "formats/container.h"
#include "formats/patch_tree.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

using Labelled = std::function<std::uint32_t(const glm::vec3& middle, const glm::vec3& normal)>;

/// A mesh, its material at a surface point, and the distance from there to another material.
struct Scene {
    TriangleMesh mesh;
    Labelled material;
    std::function<float(const glm::vec3& at, const glm::vec3& normal)> to_border;

    Scene(TriangleMesh of, const std::vector<std::string>& names, Labelled label)
        : mesh(std::move(of)), material(std::move(label)) {
        for (const std::string& name : names) {
            mesh.surface_names.push_back({0, "node", name});
        }
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto [a, b, c] = cornersOf(mesh, i);
            mesh.labels.push_back(material((a + b + c) / 3.0F, glm::vec3(unitNormal(mesh, i))));
        }
    }
};

std::uint32_t sideOf(const glm::vec3& normal) {
    for (int i = 0; i < 3; ++i) {
        if (std::abs(normal[i]) > 0.9F) {
            return static_cast<std::uint32_t>(2 * i + (normal[i] < 0.0F ? 1 : 0));
        }
    }
    return 0;
}

/// Each side of the box has its own material.
Scene dice() {
    Scene scene(makeBoxMesh(glm::dvec3(0.1, -0.2, 0.3), glm::dvec3(1.0, 0.6, 0.8)),
                {"px", "nx", "py", "ny", "pz", "nz"},
                [](const glm::vec3&, const glm::vec3& n) { return sideOf(n); });
    scene.to_border = [](const glm::vec3& at, const glm::vec3& n) {
        const glm::vec3 from = glm::vec3(1.0F, 0.6F, 0.8F) - glm::abs(at - glm::vec3(0.1F, -0.2F, 0.3F));
        float least = 1e9F;
        for (int i = 0; i < 3; ++i) {
            least = std::abs(n[i]) > 0.9F ? least : std::min(least, from[i]);
        }
        return least;
    };
    return scene;
}

constexpr float kSquare = 0.25F;  ///< side length of a square

/// A slab whose top is a checkerboard of 8 x 8 squares. Its other sides have a third material.
Scene checkerboard() {
    const TriangleMesh below = without(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0, 0.1, 1.0)),
                                       [](const glm::dvec3& p) { return p.y > 0.09; });
    Scene scene(joined({makePlane(0.1F, 8), below}), {"black", "white", "side"},
                [](const glm::vec3& at, const glm::vec3& n) -> std::uint32_t {
                    const int x = static_cast<int>(std::floor((at.x + 1.0F) / kSquare));
                    const int z = static_cast<int>(std::floor((at.z + 1.0F) / kSquare));
                    return n.y < 0.5F ? 2U : static_cast<std::uint32_t>((x + z) & 1);
                });
    scene.to_border = [](const glm::vec3& at, const glm::vec3& n) {
        const auto toLine = [](float x) {
            const float q = (x + 1.0F) / kSquare;
            return kSquare * std::abs(q - std::round(q));
        };
        return n.y > 0.5F ? std::min(toLine(at.x), toLine(at.z)) : n.y < -0.5F ? 1e9F : std::abs(0.1F - at.y);
    };
    return scene;
}

/// A board three texels thick: wood above, felt below, and a wooden rim.
Scene board() {
    Scene scene(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0, 0.025, 1.0)), {"wood", "felt"},
                [](const glm::vec3&, const glm::vec3& n) { return n.y < -0.5F ? 1U : 0U; });
    scene.to_border = [](const glm::vec3& at, const glm::vec3& n) {
        return n.y > 0.5F || n.y < -0.5F ? std::min(1.0F - std::abs(at.x), 1.0F - std::abs(at.z))
                                         : at.y + 0.025F;
    };
    return scene;
}

/// The collider's surface point along a mesh normal.
std::optional<glm::vec3> contactAlong(const Collider& collider, const glm::vec3& at, const glm::vec3& n,
                                      float reach) {
    const auto inside = [&](float along) { return evaluate(collider, at + along * n).inside(); };
    float low = -reach;
    float high = reach;
    if (!inside(low) || inside(high)) {
        return std::nullopt;
    }
    for (int i = 0; i < 24; ++i) {
        const float middle = 0.5F * (low + high);
        (inside(middle) ? low : high) = middle;
    }
    return at + high * n;
}

/// Texel size at a point: patches of flat surfaces have large texels.
float texelAt(const Collider& collider, const glm::vec3& p) {
    const DepthMap& map = collider.maps[0];
    if (map.format != MapFormat::kPatches) {
        return finestTexel(collider);
    }
    const PatchLeaf leaf = patchLeafAt(map.texels, map.object_to_map.apply(p));
    const std::uint32_t side = leaf.record.side();
    return map.object_per_map.x * leaf.cell / static_cast<float>(std::max(side, 2U) - 1);
}

struct Count {
    int contacts = 0;
    int wrong = 0;
};

Count countContacts(const Collider& collider, const Scene& scene) {
    const AreaTable areas(scene.mesh);
    MersenneRandom random(seedFrom(7));
    Count count;
    for (int k = 0; k < 10'000; ++k) {
        const SurfaceDraw draw = drawOnSurface(scene.mesh, areas, random.uniform(), random);
        const glm::vec3 at(draw.position);
        const glm::vec3 n(draw.normal);
        const float texel = texelAt(collider, at);
        if (scene.to_border(at, n) <= texel) {
            continue;
        }
        const std::optional<glm::vec3> contact = contactAlong(collider, at, n, 2.0F * texel);
        if (!contact) {
            continue;
        }
        ++count.contacts;
        const FieldSample field = evaluate(collider, *contact - 1e-4F * texel * n);
        const std::size_t material =
            materialAt(collider.materials, *contact, field.map >= 0 ? field.normal : n);
        const std::string& name = scene.mesh.surface_names[scene.material(at, n)].material;
        count.wrong += collider.materials.list[material].name != name ? 1 : 0;
    }
    return count;
}

struct Format {
    const char* name;
    std::vector<std::string> maps;  ///< if empty, patches are planned
};

std::vector<Format> formats() {
    const auto sixOf = [](const std::string& format) {
        std::vector<std::string> maps;
        for (const char* dir : {"+x", "-x", "+y", "-y", "+z", "-z"}) {
            maps.push_back(format + ":size=128x128,dir=" + dir);
        }
        return maps;
    };
    return {{"fixed8", sixOf("fixed8")},
            {"front-back",
             {"front-back:size=128x128,dir=+x", "front-back:size=128x128,dir=-y",
              "front-back:size=128x128,dir=+z"}},
            {"cube", {"cube:size=128"}},
            {"patches", {}}};
}

BakeResult baked(const TriangleMesh& mesh, const Format& format, std::optional<unsigned> threads = {}) {
    BakeRequest request;
    request.map = format.maps;
    if (format.maps.empty()) {
        request.texel = 0.016F;
    }
    request.no_check = true;
    request.threads = threads;
    return required(bake(request, {}, mesh));
}

bool isWithinItsShare(const Collider& collider) {
    return static_cast<double>(collider.materials.bytes()) <=
           std::max(kMaterialsFractionMax * static_cast<double>(collider.texelBytes()),
                    double{kMaterialsBytesMin});
}

TEST(MaterialTree, ContactsHaveTheRightMaterialInEveryFormat) {
    const std::pair<const char*, Scene> scenes[] = {
        {"sides of a box", dice()}, {"squares", checkerboard()}, {"sides of a thin board", board()}};
    for (const auto& [what, scene] : scenes) {
        for (const Format& format : formats()) {
            SCOPED_TRACE(std::string(what) + " in " + format.name);
            const Collider collider = baked(scene.mesh, format).baked.collider;
            ASSERT_FALSE(collider.materials.empty());
            EXPECT_EQ(faultOfMaterials(collider.materials), "");
            const Count count = countContacts(collider, scene);
            EXPECT_GT(count.contacts, format.maps.empty() ? 100 : 1000);
            EXPECT_LE(count.wrong, count.contacts / 100);
            EXPECT_TRUE(isWithinItsShare(collider));
        }
    }
}

TEST(MaterialSamples, NeighborMaterialsMatchBruteForce) {
    const TriangleMesh mesh = checkerboard().mesh;
    std::vector<std::uint8_t> labels(mesh.labels.begin(), mesh.labels.end());
    const MeshQuery query = queryOf(mesh);
    MersenneRandom random(seedFrom(11));
    int near = 0;
    for (int k = 0; k < 2000; ++k) {
        const glm::vec3 p(inCube(random) * glm::dvec3(1.2, 0.5, 1.2));
        const double radius = 0.4 * random.uniform();
        const auto label = static_cast<std::uint8_t>(k % 3);
        double least = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto [a, b, c] = cornersOf(mesh, i);
            const glm::dvec3 off = closestOnTriangle(p, a, b, c) - glm::dvec3(p);
            least = labels[i] == label ? least : std::min(least, std::sqrt(dot(off, off)));
        }
        ASSERT_EQ(query.hasOtherLabelWithin(p, radius, labels, label), least <= radius) << k;
        near += least <= radius ? 1 : 0;
    }
    EXPECT_GT(near, 300);
    EXPECT_LT(near, 1700);
}

TEST(MaterialTree, IsDeterministicAndRoundTrips) {
    const Scene scene = checkerboard();
    const Format patches = formats().back();
    const Collider collider = baked(scene.mesh, patches, 1).baked.collider;
    EXPECT_EQ(collider, baked(scene.mesh, patches, 4).baked.collider);
    for (const int level : {0, 3}) {
        EXPECT_EQ(required(readContainer(required(writeContainer(collider, {level})))), collider);
    }
}

TEST(MaterialTree, SingleMaterialNeedsNoTree) {
    const Format patches = formats().back();
    TriangleMesh plain = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    const auto halves = [&](const char* left, const char* right) {
        return Scene(plain, {left, right},
                     [](const glm::vec3& at, const glm::vec3&) { return at.x > 0.0F ? 1U : 0U; })
            .mesh;
    };
    EXPECT_EQ(baked(halves("a", "a"), patches).baked.collider.materials, Materials());
    BakeRequest request;
    request.texel = 0.1F;
    request.no_check = true;
    const TriangleMesh named = halves("a", "b");
    const Collider kept = bake(request, {}, named)->baked.collider;
    request.materials = MaterialMode::kDrop;
    const Collider none = bake(request, {}, named)->baked.collider;
    EXPECT_EQ(kept.materials.list.size(), 2U);
    EXPECT_NEAR(double{kept.materials.list[0].area_fraction}, 0.5, 1e-6);
    EXPECT_EQ(none.materials, Materials());
    EXPECT_EQ(kept.maps, none.maps);
    // On request, a single material is also kept: levels distinguish meshes by material name.
    plain.surface_names = {{0, "node", "stone"}};
    request.materials = MaterialMode::kKeep;
    const Collider single = bake(request, {}, plain)->baked.collider;
    ASSERT_EQ(single.materials.list.size(), 1U);
    EXPECT_EQ(single.materials.list[0].name, "stone");
    EXPECT_EQ(materialAt(single.materials, glm::vec3(5.0F), glm::vec3(0.0F)), 0U);
}

TEST(MaterialTree, RejectsTooManyNamesAndConflictingResponses) {
    TriangleMesh mesh = makePlane(0.0F, 16);
    for (int i = 0; i < 300; ++i) {
        mesh.surface_names.push_back({0, "node", "m" + std::to_string(i)});
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        mesh.labels.push_back(i % 300);
    }
    expectError(materialSource(mesh, false), ErrorCode::kLimit);
    mesh.surface_names = {{0, "floor", "wood", 0.5F, 0.0F}, {1, "door", "wood", 0.25F, 0.0F}};
    for (std::uint32_t& label : mesh.labels) {
        label %= 2;
    }
    for (const char* const name : {"'wood'", "'door'"}) {
        expectError(materialSource(mesh, false), ErrorCode::kInvalidInput, name);
    }
}

}  // namespace
}  // namespace relief::test
