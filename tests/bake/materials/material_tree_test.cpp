// Which surface is of which material: at contacts with baked maps of every format, against meshes whose borders are known in
// closed form. A tree whose cells are too large, not dilated or turned the wrong way is wrong at more than a hundredth of them.
#include "bake/materials/material_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "bake/director/director.h"
#include "bake/import/mesh_import.h"
#include "bake/mesh/mesh_query.h"
#include "formats/base/text.h"
#include "formats/container.h"
#include "formats/patch_tree.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

using Labelled = std::function<std::uint32_t(const glm::vec3& middle, const glm::vec3& normal)>;

TriangleMesh labelled(TriangleMesh mesh, const std::vector<std::string>& names, const Labelled& label) {
    for (const std::string& name : names) {
        mesh.surface_names.push_back({0, "node", name});
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = cornersOf(mesh, i);
        mesh.labels.push_back(label((a + b + c) / 3.0F, glm::vec3(unitNormal(mesh, i))));
    }
    return mesh;
}

std::uint32_t sideOf(const glm::vec3& normal) {
    for (int i = 0; i < 3; ++i) {
        if (std::abs(normal[i]) > 0.9F) {
            return static_cast<std::uint32_t>(2 * i + (normal[i] < 0.0F ? 1 : 0));
        }
    }
    return 0;
}

/// A mesh, its material at a point of its surface, and how far that is from another material.
struct Scene {
    TriangleMesh mesh;
    Labelled material;
    std::function<float(const glm::vec3& at, const glm::vec3& normal)> to_border;
};

/// Each side has its own material.
Scene dice() {
    Scene scene;
    scene.mesh = labelled(makeBoxMesh(glm::dvec3(0.1, -0.2, 0.3), glm::dvec3(1.0, 0.6, 0.8)),
                          {"px", "nx", "py", "ny", "pz", "nz"},
                          [](const glm::vec3&, const glm::vec3& n) { return sideOf(n); });
    scene.material = [](const glm::vec3&, const glm::vec3& n) { return sideOf(n); };
    scene.to_border = [](const glm::vec3& at, const glm::vec3& n) {
        const glm::vec3 half(1.0F, 0.6F, 0.8F);
        const glm::vec3 from = half - glm::abs(at - glm::vec3(0.1F, -0.2F, 0.3F));
        float least = 1e9F;
        for (int i = 0; i < 3; ++i) {
            least = std::abs(n[i]) > 0.9F ? least : std::min(least, from[i]);
        }
        return least;
    };
    return scene;
}

constexpr float kSquare = 0.25F;  ///< a side

/// A slab whose top is a checkerboard of 8 x 8 squares; its other sides are a third material.
Scene checkerboard() {
    TriangleMesh top = makePlane(0.1F, 8);
    TriangleMesh slab = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0, 0.1, 1.0));
    std::vector<glm::uvec3> kept;
    for (std::uint32_t i = 0; i < slab.triangles.size(); ++i) {
        if (unitNormal(slab, i).y < 0.5) {
            kept.push_back(slab.triangles[i]);
        }
    }
    slab.triangles = kept;
    const Labelled material = [](const glm::vec3& at, const glm::vec3& n) -> std::uint32_t {
        if (n.y < 0.5F) {
            return 2;
        }
        const int x = static_cast<int>(std::floor((at.x + 1.0F) / kSquare));
        const int z = static_cast<int>(std::floor((at.z + 1.0F) / kSquare));
        return static_cast<std::uint32_t>((x + z) & 1);
    };
    Scene scene;
    scene.mesh = labelled(joined({top, finished(slab.positions, slab.triangles)}), {"black", "white", "side"},
                          material);
    scene.material = material;
    scene.to_border = [](const glm::vec3& at, const glm::vec3& n) {
        const auto toLine = [](float x) {
            const float q = (x + 1.0F) / kSquare;
            return kSquare * std::abs(q - std::round(q));
        };
        return n.y > 0.5F ? std::min(toLine(at.x), toLine(at.z)) : n.y < -0.5F ? 1e9F : std::abs(0.1F - at.y);
    };
    return scene;
}

/// A board three texels thick, wood above and felt below; its rim is wood.
Scene board() {
    Scene scene;
    const Labelled material = [](const glm::vec3&, const glm::vec3& n) -> std::uint32_t {
        return n.y < -0.5F ? 1 : 0;
    };
    scene.mesh =
        labelled(makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0, 0.025, 1.0)), {"wood", "felt"}, material);
    scene.material = material;
    scene.to_border = [](const glm::vec3& at, const glm::vec3& n) {
        return n.y > 0.5F || n.y < -0.5F ? std::min(1.0F - std::abs(at.x), 1.0F - std::abs(at.z))
                                         : at.y + 0.025F;
    };
    return scene;
}

/// The collider's surface along a normal of the mesh.
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

/// Of the maps there: patches of flat surfaces are large.
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

/// Points of a mesh, spread evenly over its area.
class SurfacePoints {
  public:
    SurfacePoints(const TriangleMesh& mesh, std::uint32_t seed) : mesh_(mesh), random_(seedFrom(seed)) {
        double area = 0.0;
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            area += length(planeOf(mesh, i).normal);
            sums_.push_back(area);
        }
    }
    struct Point {
        glm::vec3 at;
        glm::vec3 normal;
    };
    Point next() {
        const auto found =
            std::lower_bound(sums_.begin(), sums_.end(), sums_.back() * static_cast<double>(unit()));
        const auto i = static_cast<std::uint32_t>(
            std::min<std::ptrdiff_t>(found - sums_.begin(), static_cast<std::ptrdiff_t>(sums_.size()) - 1));
        const auto [a, b, c] = cornersOf(mesh_, i);
        const float root = std::sqrt(unit());
        const float share = unit();
        return {(1.0F - root) * a + root * (1.0F - share) * b + root * share * c,
                glm::vec3(unitNormal(mesh_, i))};
    }

  private:
    float unit() { return static_cast<float>(static_cast<double>(random_()) / 4294967296.0); }

    const TriangleMesh& mesh_;
    std::mt19937 random_;
    std::vector<double> sums_;
};

Count countContacts(const Collider& collider, const Scene& scene) {
    SurfacePoints points(scene.mesh, 7);
    Count count;
    for (int k = 0; k < 10'000; ++k) {
        const auto [at, n] = points.next();
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
    std::vector<std::string> maps;  ///< empty: planned patches
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
    Result<BakeResult> result = bake(request, {}, mesh);
    EXPECT_TRUE(result) << format.name << ": " << (result ? "" : result.error().message);
    return result ? std::move(*result) : BakeResult();
}

bool isWithinItsShare(const Collider& collider) {
    return static_cast<double>(collider.materials.bytes()) <=
           std::max(kMaterialsShare * static_cast<double>(collider.gpuBytes()), double{kMaterialsBytesMin});
}

TEST(MaterialTree, ContactsAreRightInEveryFormat) {
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

/// The material of the nearest triangle, and how far the nearest of another one is.
struct Nearest {
    std::string material;
    glm::vec3 foot{0.0F};  ///< on that triangle
    double to_other = 0.0;
};

Nearest nearestOf(const TriangleMesh& mesh, const glm::vec3& p) {
    std::map<std::string, double> squares;
    Nearest nearest;
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = cornersOf(mesh, i);
        const glm::dvec3 off = closestOnTriangle(p, a, b, c) - glm::dvec3(p);
        const std::string& name = mesh.surface_names[mesh.labels[i]].material;
        const auto [found, added] = squares.try_emplace(name, dot(off, off));
        found->second = std::min(found->second, dot(off, off));
        if (dot(off, off) < least) {
            least = dot(off, off);
            nearest.material = name;
            nearest.foot = glm::vec3(glm::dvec3(p) + off);
        }
    }
    nearest.to_other = std::numeric_limits<double>::infinity();
    for (const auto& [name, square] : squares) {
        nearest.to_other =
            name == nearest.material ? nearest.to_other : std::min(nearest.to_other, std::sqrt(square));
    }
    return nearest;
}

// Contacts are where rays towards points of the surface first enter the collider, further than a texel from any other material. A
// shell stands off its sheet by half its thickness, so that borders below its contacts never are within a texel of them: the second
// figure measures from the contact's foot on the mesh. With RELIEF_MESHES=A.obj:B.obj in the environment of these files, too.
TEST(MaterialTree, MeshesAsPeopleMakeThemAreRight) {
    std::vector<std::string> files{"/usr/share/assimp/models/OBJ/spider.obj"};
    if (const char* const more = std::getenv("RELIEF_MESHES"); more != nullptr) {
        for (const std::string_view file : split(more, ':')) {
            files.emplace_back(file);
        }
    }
    for (const std::string& file : files) {
        const Result<TriangleMesh> mesh = importMeshInWorker(file);
        ASSERT_TRUE(mesh) << mesh.error().message;
        for (const Format& format : {Format{"patches of 1 MB", {}}, formats()[1]}) {
            BakeRequest request;
            request.map = format.maps;
            request.no_check = true;
            const Result<BakeResult> result = bake(request, {}, *mesh);
            ASSERT_TRUE(result) << result.error().message;
            const Collider& collider = result->baked.collider;
            SurfacePoints points(*mesh, 3);
            Count count;
            Count by_foot;
            for (int k = 0; k < 4000; ++k) {
                const auto [at, n] = points.next();
                const float texel = texelAt(collider, at);
                const std::optional<glm::vec3> contact = contactAlong(collider, at, n, 1.5F * texel);
                if (!contact) {
                    continue;
                }
                const Nearest nearest = nearestOf(*mesh, *contact);
                if (nearest.to_other <= double{texel}) {
                    continue;
                }
                ++count.contacts;
                const FieldSample field = evaluate(collider, *contact - 1e-3F * texel * n);
                const std::size_t material =
                    materialAt(collider.materials, *contact, field.map >= 0 ? field.normal : n);
                const int wrong = collider.materials.list[material].name != nearest.material ? 1 : 0;
                count.wrong += wrong;
                if (nearestOf(*mesh, nearest.foot).to_other > double{texel}) {
                    ++by_foot.contacts;
                    by_foot.wrong += wrong;
                }
            }
            std::printf(
                "%s, %s: %d of %d contacts wrong, by their feet %d of %d; %zu materials, %.2f %% of %llu "
                "bytes\n",
                mesh->name.c_str(), format.name, count.wrong, count.contacts, by_foot.wrong, by_foot.contacts,
                collider.materials.list.size(),
                100.0 * static_cast<double>(collider.materials.bytes()) /
                    static_cast<double>(collider.gpuBytes()),
                static_cast<unsigned long long>(collider.gpuBytes()));
            EXPECT_GT(count.contacts, 400) << file << ", " << format.name;
            EXPECT_LE(count.wrong * 100, count.contacts) << file << ", " << format.name;
            EXPECT_LE(by_foot.wrong * 100, by_foot.contacts) << file << ", " << format.name;
            EXPECT_TRUE(isWithinItsShare(collider)) << file << ", " << format.name;
        }
    }
}

TEST(MaterialSamples, OtherMaterialsNearAreThoseOfAllTriangles) {
    TriangleMesh mesh = checkerboard().mesh;
    std::vector<std::uint8_t> labels(mesh.labels.begin(), mesh.labels.end());
    const Result<MeshQuery> query = MeshQuery::build(mesh);
    ASSERT_TRUE(query);
    std::mt19937 random(seedFrom(11));
    const auto share = [&] { return static_cast<float>(random()) / 4294967296.0F; };
    int near = 0;
    for (int k = 0; k < 2000; ++k) {
        const glm::vec3 p(2.4F * share() - 1.2F, share() - 0.5F, 2.4F * share() - 1.2F);
        const double radius = 0.4 * double{share()};
        const auto label = static_cast<std::uint8_t>(k % 3);
        double least = std::numeric_limits<double>::infinity();
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto [a, b, c] = cornersOf(mesh, i);
            const glm::dvec3 off = closestOnTriangle(p, a, b, c) - glm::dvec3(p);
            least = labels[i] == label ? least : std::min(least, std::sqrt(dot(off, off)));
        }
        ASSERT_EQ(query->otherWithin(p, radius, labels, label), least <= radius) << k;
        near += least <= radius ? 1 : 0;
    }
    EXPECT_GT(near, 300);
    EXPECT_LT(near, 1700);
}

TEST(MaterialTree, IsTheSameForAnyNumberOfThreadsAndSurvivesTheContainer) {
    const Scene scene = checkerboard();
    const Format patches = formats().back();
    const Collider collider = baked(scene.mesh, patches, 1).baked.collider;
    EXPECT_EQ(collider, baked(scene.mesh, patches, 4).baked.collider);
    for (const int level : {0, 3}) {
        const auto bytes = writeContainer(collider, {level});
        ASSERT_TRUE(bytes);
        const auto read = readContainer(*bytes);
        ASSERT_TRUE(read) << read.error().message;
        EXPECT_EQ(*read, collider);
        EXPECT_EQ(readContainerInfo(*bytes)->minor, 6);
    }
}

TEST(MaterialTree, OfOneMaterialThereIsNone) {
    const Format patches = formats().back();
    TriangleMesh plain = makeBoxMesh(glm::dvec3(0.0), glm::dvec3(1.0));
    const Collider without = baked(plain, patches).baked.collider;
    TriangleMesh named =
        labelled(plain, {"a", "a"},
                 [](const glm::vec3& at, const glm::vec3&) -> std::uint32_t { return at.x > 0.0F ? 1 : 0; });
    EXPECT_EQ(baked(named, patches).baked.collider.materials, Materials());
    EXPECT_EQ(without.materials, Materials());
    BakeRequest request;
    request.texel = 0.1F;
    request.no_check = true;
    named = labelled(plain, {"a", "b"}, [](const glm::vec3& at, const glm::vec3&) -> std::uint32_t {
        return at.x > 0.0F ? 1 : 0;
    });
    const Collider kept = bake(request, {}, named)->baked.collider;
    request.materials = MaterialsAs::kNone;
    const Collider none = bake(request, {}, named)->baked.collider;
    EXPECT_EQ(kept.materials.list.size(), 2U);
    EXPECT_NEAR(double{kept.materials.list[0].area_share}, 0.5, 1e-6);
    EXPECT_EQ(none.materials, Materials());
    EXPECT_EQ(kept.maps, none.maps);
    // Requested, a single one is kept, too: a level of many meshes has it told apart by name.
    plain.surface_names = {{0, "node", "stone"}};
    request.materials = MaterialsAs::kKeep;
    const Collider single = bake(request, {}, plain)->baked.collider;
    ASSERT_EQ(single.materials.list.size(), 1U);
    EXPECT_EQ(single.materials.list[0].name, "stone");
    EXPECT_TRUE(single.materials.nodes.empty());
    EXPECT_EQ(materialAt(single.materials, glm::vec3(5.0F), glm::vec3(0.0F)), 0U);
}

TEST(MaterialTree, TooManyNamesAndOneWithTwoResponsesAreErrors) {
    TriangleMesh mesh = makePlane(0.0F, 16);
    for (int i = 0; i < 300; ++i) {
        mesh.surface_names.push_back({0, "node", "m" + std::to_string(i)});
    }
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        mesh.labels.push_back(i % 300);
    }
    const auto many = materialSource(mesh, false);
    ASSERT_FALSE(many);
    EXPECT_EQ(many.error().code, ErrorCode::kLimit);
    mesh.surface_names = {{0, "floor", "wood", 0.5F, 0.0F}, {1, "door", "wood", 0.25F, 0.0F}};
    for (std::uint32_t& label : mesh.labels) {
        label %= 2;
    }
    const auto twice = materialSource(mesh, false);
    ASSERT_FALSE(twice);
    EXPECT_EQ(twice.error().code, ErrorCode::kInvalidInput);
    EXPECT_NE(twice.error().message.find("'wood'"), std::string::npos) << twice.error().message;
    EXPECT_NE(twice.error().message.find("'door'"), std::string::npos) << twice.error().message;
}

}  // namespace
}  // namespace relief::test
