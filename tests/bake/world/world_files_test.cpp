// SPDX-License-Identifier: Apache-2.0
// Manual edits of a world.json survive the next bake; worlds with lost thin parts; and coarse colliders.
#include <algorithm>
#include <array>
#include <functional>
#include <glm/geometric.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/pipeline/bake.h"
#include "bake/report/world_report.h"
#include "bake/world/coarse_collider.h"
#include "bake/world/world_check.h"
#include "bake/world/world_files.h"
#include "tests/bake/meshes.h"
#include "tests/bake/points.h"
#include "tests/bake/world/level_bakes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

class WrittenByHand : public LevelBakes {
  protected:
    void SetUp() override {
        request_.bake.budget = 64'000;
        request_.bake.quality = Quality::kFast;
        request_.bake.no_check = true;
        writeLevel({{"door", "oak"}, {"floor", "stone"}});
    }

    /// Writes a cube of half side 0.5 for each pair of an object name and a material.
    void writeLevel(const std::vector<std::array<std::string, 2>>& cubes) const {
        std::vector<Object> objects;
        for (const auto& [name, material] : cubes) {
            const float x = 3.0F * static_cast<float>(objects.size());
            objects.push_back({name, makeBoxMesh(glm::dvec3(0.5), glm::dvec3(0.5)), {x, 0.0F, 0.0F}});
        }
        write(objects, [&](const Object& object, std::size_t) {
            return std::ranges::find(cubes, object.name, [](const auto& cube) { return cube[0]; })->at(1);
        });
    }

    [[nodiscard]] fs::path worldFile() const { return folder_.path() / "w" / kWorldFileName; }

    /// Edits world.json as with a text editor.
    void edit(const std::function<void(World&)>& change) const {
        World world = *loadWorldFile(worldFile());
        change(world);
        const std::string text = worldText(world);
        ASSERT_TRUE(writeFile(worldFile(), std::as_bytes(std::span(text))));
    }

    /// Returns the warnings.
    [[nodiscard]] std::vector<std::string> replace(World& world) const {
        fs::create_directories(worldFile().parent_path());
        return required(replaceWorld(worldFile().parent_path(), world, {}, "level")).warnings;
    }

    [[nodiscard]] std::vector<std::byte> bytes() const { return *readFile(worldFile()); }
};

using Bodies = std::vector<std::pair<std::string, float>>;
Bodies frictionOf(const World& world) {
    Bodies bodies;
    for (const WorldBody& body : world.bodies) {
        bodies.emplace_back(body.node, body.friction);
    }
    return bodies;
}

/// The x of a node's position, and the side of its mesh.
struct Node {
    std::string name;
    float x = 0.0F;
    float side = 1.0F;
};
/// A baked world with a body and a collider for each node.
World placed(const std::vector<Node>& nodes) {
    World world;
    for (const Node& node : nodes) {
        const auto number = static_cast<std::uint32_t>(world.colliders.size());
        world.colliders.push_back({{"m" + std::to_string(number) + ".relief", std::string(32, '0'), 1},
                                   "m",
                                   {glm::vec3(0.0F), glm::vec3(node.side)},
                                   {}});
        WorldBody& body = world.bodies.emplace_back();
        body.collider = number;
        body.node = node.name;
        body.position.x = node.x;
        body.rotation = {0.1F, 0.2F, 0.3F, 0.9273618F};  // normalized, except for rounding
    }
    return world;
}

TEST_F(WrittenByHand, MaterialResponsesAreKeptByName) {
    EXPECT_TRUE(bake("w").world.materials.empty());
    const std::vector<MaterialResponse> given{{"stone", 0.25F, {}, {}}, {"oak", {}, 0.5F, 1.0F}};
    edit([&](World& world) { world.materials = given; });
    const std::vector<std::byte> edited = bytes();
    const WorldBakeResult again = bake("w");
    EXPECT_TRUE(again.warnings.empty());
    EXPECT_EQ(again.countOf(WorldColliderState::kUpToDate), 2U);
    EXPECT_EQ(bytes(), edited);
    writeLevel({{"door", "oak"}, {"floor", "sand"}, {"roof", "slate"}});
    const WorldBakeResult changed = bake("w");
    EXPECT_EQ(changed.world.materials, (std::vector<MaterialResponse>{given[1]}));
    EXPECT_EQ(changed.warnings, std::vector<std::string>{
                                    "world.json: no collider has the material 'stone' any more; its response "
                                    "is dropped"});
    EXPECT_TRUE(loadWorld(worldFile())) << "the reader rejects unknown material names";
    EXPECT_TRUE(bake("w").warnings.empty());
}

TEST_F(WrittenByHand, BodyResponsesAreKeptByNode) {
    World world = placed({{"door"}, {"gate"}, {"gate"}, {"floor"}});
    EXPECT_TRUE(replace(world).empty());
    edit([](World& edited) {
        for (std::size_t i = 0; i < 4; ++i) {
            edited.bodies[i].friction = 0.25F * static_cast<float>(i);
        }
        edited.bodies[3].restitution = 0.5F;
    });
    // Matched by order within each name, at any position.
    world = placed({{"roof"}, {"floor"}, {"gate"}, {"gate"}, {"door"}});
    EXPECT_TRUE(replace(world).empty());
    EXPECT_EQ(frictionOf(world),
              (Bodies{{"roof", 0.0F}, {"floor", 0.75F}, {"gate", 0.25F}, {"gate", 0.5F}, {"door", 0.0F}}));
    EXPECT_EQ(world.bodies[1].restitution, 0.5F);
    EXPECT_EQ(frictionOf(*loadWorldFile(worldFile())), frictionOf(world));
    // Three gates cannot be matched with two. A removed node without a response causes no warning.
    world = placed({{"gate"}, {"gate"}, {"gate"}});
    const std::vector<std::string> warnings = replace(world);
    EXPECT_EQ(frictionOf(world), (Bodies{{"gate", 0.0F}, {"gate", 0.0F}, {"gate", 0.0F}}));
    EXPECT_EQ(warnings, std::vector<std::string>{
                            "world.json: the bodies of 'floor', 'gate' are missing or ambiguous; their "
                            "restitution and friction are dropped"});
    // Equal responses apply to any number of bodies, such as tiles.
    edit([](World& edited) {
        for (WorldBody& body : edited.bodies) {
            body.friction = 0.125F;
        }
    });
    world = placed({{"gate"}, {"gate"}});
    EXPECT_TRUE(replace(world).empty());
    EXPECT_EQ(frictionOf(world), (Bodies{{"gate", 0.125F}, {"gate", 0.125F}}));
}

// Each list of nodes replaces the first one, whose frictions were edited.
TEST_F(WrittenByHand, ResponsesFollowTheMatchingBody) {
    const std::vector<Node> before = {
        {"gate", 0, 1}, {"gate", 5, 1}, {"gate", 9, 1}, {"door", 2, 3}, {"", 4, 2}};
    struct Case {
        const char* what;
        std::vector<Node> nodes;
        std::vector<float> friction;
        std::string gone;
    };
    const std::vector<Case> cases = {
        {"swapped",
         {{"door", 2, 3}, {"gate", 9, 1}, {"", 4, 2}, {"gate", 0, 1}, {"gate", 5, 1}},
         {0.5F, 0.375F, 0.625F, 0.0F, 0.25F},
         ""},
        {"removed, and another one added",
         {{"gate", 0, 1}, {"gate", 7, 1}, {"gate", 9, 1}, {"door", 2, 3}, {"", 4, 2}},
         {0.0F, 0.0F, 0.375F, 0.5F, 0.625F},
         "'gate'"},
        {"removed",
         {{"gate", 0, 1}, {"gate", 9, 1}, {"door", 2, 3}, {"", 4, 2}},
         {0.0F, 0.375F, 0.5F, 0.625F},
         "'gate'"},
        {"renamed",
         {{"gate", 0, 1}, {"gate.1", 5, 1}, {"gate", 9, 1}, {"portal", 2, 3}, {"", 4, 2}},
         {0.0F, 0.25F, 0.375F, 0.5F, 0.625F},
         ""},
        {"renamed, and another has the name",
         {{"gate", 0, 1}, {"gate", 5, 1}, {"gate", 9, 1}, {"portal", 2, 3}, {"door", 8, 7}, {"", 4, 2}},
         {0.0F, 0.25F, 0.375F, 0.5F, 0.0F, 0.625F},
         ""},
        {"moved, and of another mesh",
         {{"gate", 0, 1}, {"gate", 5, 1}, {"gate", 9, 1}, {"door", 6, 4}, {"", 4, 2}},
         {0.0F, 0.25F, 0.375F, 0.5F, 0.625F},
         ""},
        {"all but one gone", {{"gate", 9, 1}}, {0.375F}, "'gate', 'door', '(without a name)'"},
    };
    for (const Case& one : cases) {
        SCOPED_TRACE(one.what);
        fs::remove(worldFile());
        World world = placed(before);
        EXPECT_TRUE(replace(world).empty());
        edit([](World& edited) {
            for (std::size_t i = 1; i < edited.bodies.size(); ++i) {
                edited.bodies[i].friction = 0.125F * static_cast<float>(i + 1);
            }
        });
        world = placed(one.nodes);
        const std::vector<std::string> warnings = replace(world);
        std::vector<float> friction;
        for (const WorldBody& body : world.bodies) {
            friction.push_back(body.friction);
        }
        EXPECT_EQ(friction, one.friction);
        ASSERT_EQ(warnings.size(), one.gone.empty() ? 0U : 1U);
        EXPECT_TRUE(one.gone.empty() || warnings[0].find(one.gone) != std::string::npos) << warnings[0];
    }
}

TEST_F(WrittenByHand, UnreadableFileIsReplacedWithAWarning) {
    static_cast<void>(bake("w"));
    const std::vector<std::byte> first = bytes();
    std::vector<std::byte> damaged = first;
    damaged.push_back(std::byte{'x'});
    ASSERT_TRUE(writeFile(worldFile(), damaged));
    const WorldBakeResult again = bake("w");
    ASSERT_EQ(again.warnings.size(), 1U);
    EXPECT_NE(again.warnings[0].find("world.json"), std::string::npos) << again.warnings[0];
    EXPECT_EQ(again.warnings[0].find('\n'), std::string::npos);
    EXPECT_EQ(bytes(), first);
}

using WorldCheck = LevelBakes;

TEST_F(WorldCheck, AdvisesNoBudgetIfFloatsAreTooCoarse) {
    std::string far = "o far\n";
    const TriangleMesh torus = makeTorusMesh(0.5, 0.15, 24, 12);
    for (const glm::vec3& p : torus.positions) {
        far += "v " + std::to_string(4e5 + double{p.x}) + " " + std::to_string(p.y) + " " +
               std::to_string(4e5 + double{p.z}) + "\n";
    }
    for (const glm::uvec3& t : torus.triangles) {
        far += "f " + std::to_string(t.x + 1) + " " + std::to_string(t.y + 1) + " " +
               std::to_string(t.z + 1) + "\n";
    }
    folder_.write("level.obj", far);
    request_.bake.budget = 60'000;
    const WorldBakeResult baked = bake("w");
    const WorldField field = load("w");
    const WorldAccuracy accuracy = check(field, 10'000);
    EXPECT_GT(accuracy.all.total(), 5.0);
    EXPECT_EQ(accuracy.places.front().cause, WorldCause::kPrecision);
    const std::string& warning = baked.colliders.front().warnings.back();
    for (const std::string& text : {worldCheckText(field, "w", &accuracy), warning}) {
        EXPECT_EQ(text.find("--budget"), std::string::npos) << text;
        EXPECT_NE(text.find("origin"), std::string::npos) << text;
    }
}

TEST_F(WorldCheck, NamesMeshesWithLostThinParts) {
    // 20 posts of 0.5 m on a slab of 20 m; most points near the mesh are far from the posts.
    const auto accuracyOf = [&](double half, std::uint64_t budget) {
        std::vector<TriangleMesh> house = {makeBoxMesh({0, 0, 0}, {10, 0.25, 10})};
        for (int i = 0; i < 20; ++i) {
            house.push_back(makeBoxMesh({0.9 * i - 9.0, 0.45, 0.2 * i - 2.0}, {half, 0.25, half}));
        }
        write({{"house", joined(house)}});
        request_.bake.budget = budget;
        static_cast<void>(bake("w"));
        WorldAccuracy accuracy = check(load("w"), 10'000);
        EXPECT_LT(accuracy.all.total(), 1.0);
        return accuracy;
    };
    const WorldAccuracy coarse = accuracyOf(0.0025, 24'000);
    ASSERT_EQ(coarse.lost.size(), 1U);
    EXPECT_EQ(coarse.lost[0].mesh, "house");
    EXPECT_GT(coarse.lost[0].lost, 10U) << coarse.lost[0].text;
    EXPECT_FALSE(coarse.passes(1.0F));
    const Verdict verdict = verdictOf(coarse, "");
    EXPECT_EQ(verdict.grade, "poor");
    EXPECT_NE(verdict.text.find("but 1 mesh lost parts"), std::string::npos) << verdict.text;
    EXPECT_TRUE(coarse.passes({}));
    const WorldAccuracy fine = accuracyOf(0.04, 300'000);
    EXPECT_TRUE(fine.lost.empty()) << fine.lost[0].text;
    EXPECT_TRUE(fine.passes(1.0F));
}

TEST_F(WorldCheck, CountsSmallLostPartsOfAllMeshes) {
    std::vector<TriangleMesh> yard = {makeBoxMesh({0, 0, 0}, {10, 0.25, 10})};
    for (int i = 0; i < 20; ++i) {
        yard.push_back(makeBoxMesh({0.9 * i - 9.0, 0.252, 0.2 * i - 2.0}, glm::dvec3(0.005)));
    }
    write({{"yard", joined(yard)}});
    request_.bake.budget = 24'000;
    const WorldBakeResult baked = bake("w");
    ASSERT_TRUE(baked.colliders[0].verdict);
    EXPECT_EQ(baked.colliders[0].verdict->grade, "good");
    EXPECT_GT(baked.colliders[0].ignored.lost, 15U);  // with 16 points each
    EXPECT_NE(worldBakeText(baked, "w", 1.0, false).find(" of 21 parts, at most 0.01 long, are not"),
              std::string::npos);
    const WorldField field = load("w");
    const WorldAccuracy accuracy = check(field, 2000);
    EXPECT_TRUE(accuracy.lost.empty());
    EXPECT_GT(accuracy.ignored.lost, 15U);
    EXPECT_EQ(verdictOf(accuracy, "").grade, "good");
    EXPECT_NE(worldCheckText(field, "w", &accuracy).find(" of 21 parts, at most 0.01 long, are not"),
              std::string::npos);
}

TEST(CoarseCollider, IsTheSameShapeInASixteenthOfTheBytes) {
    MersenneRandom random(seedFrom(41));
    for (const double radius : {0.5, 30.0}) {
        const glm::dvec3 center(3.0 * random.uniform(), 20.0, -7.0);
        const TriangleMesh mesh = makeIcosphere(center, radius, 5);
        for (const std::uint64_t budget : {150'000U, 400'000U}) {
            BakeRequest request;
            request.budget = budget;
            request.no_check = true;
            const BakeResult fine = required(bake(request, {}, mesh));
            ASSERT_TRUE(hasCoarse(fine.baked.collider));
            const FineCollider of = FineCollider::of(fine.baked.collider);
            const auto by_mesh = [&](const BakeRequest& other) { return bake(other, {}, mesh); };
            const Collider coarse = required(bakeCoarse(request, of, by_mesh));
            EXPECT_LE(16 * coarse.texelBytes(), fine.baked.collider.texelBytes());
            const Bounds outer = insideBox(coarse).value();
            const Bounds inner = insideBox(fine.baked.collider).value();
            EXPECT_TRUE(outer.contains(inner.min) && outer.contains(inner.max));
            EXPECT_EQ(coarse.bounds, fine.baked.collider.bounds);
            EXPECT_EQ(required(bakeCoarse(request, of, by_mesh)), coarse);
            // About nine thousand bytes leave slivers of a ball without patches, up to a fiftieth of the radius thick.
            int known = 0;
            int wrong = 0;
            for (int i = 0; i < 4000; ++i) {
                const glm::dvec3 p = center + 1.2 * radius * inCube(random);
                const double away = glm::distance(p, center) - radius;
                if (std::abs(away) > 0.01 * radius) {
                    ++known;
                    const bool right = evaluate(coarse, glm::vec3(p)).inside() == (away < 0.0);
                    wrong += right ? 0 : 1;
                    ASSERT_TRUE(right || std::abs(away) < 0.02 * radius) << away / radius;
                }
            }
            EXPECT_LE(wrong, 4);
            EXPECT_GT(known, 3500);
        }
    }
}

TEST(CoarseCollider, SmallCollidersAndNamedMapsHaveNone) {
    const TriangleMesh mesh = makeIcosphere({0.0, 0.0, 0.0}, 1.0, 3);
    BakeRequest request;
    request.budget = 60'000;
    EXPECT_FALSE(hasCoarse(bake(request, {}, mesh).value().baked.collider));
    request.budget.reset();
    request.map = {"front-back:dir=-x,size=256"};
    EXPECT_FALSE(hasCoarse(bake(request, {}, mesh).value().baked.collider));
}

}  // namespace
}  // namespace relief::test
