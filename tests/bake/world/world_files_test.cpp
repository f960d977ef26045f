// Values written into a world.json by hand are there after the next bake.
#include "bake/world/world_files.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/world/world_bake.h"
#include "formats/base/file_io.h"
#include "tests/temporary_folder.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

class WrittenByHand : public testing::Test {
  protected:
    /// A cube of half side 0.5 for each: its object, and its material.
    void writeLevel(const std::vector<std::array<std::string, 2>>& cubes) const {
        std::string text;
        for (std::size_t i = 0; i < cubes.size(); ++i) {
            text += "o " + cubes[i][0] + "\nusemtl " + cubes[i][1] + "\n";
            for (int corner = 0; corner < 8; ++corner) {
                text += "v " + std::to_string(3 * i + static_cast<std::size_t>(corner & 1)) + " " +
                        std::to_string(corner >> 1 & 1) + " " + std::to_string(corner >> 2) + "\n";
            }
            for (const auto& quad :
                 {std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}, std::array{0, 1, 5, 4},
                  std::array{2, 6, 7, 3}, std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}}) {
                text += "f";
                for (const int corner : quad) {
                    text += " " + std::to_string(8 * i + static_cast<std::size_t>(corner) + 1);
                }
                text += "\n";
            }
        }
        folder_.write("level.obj", text);
    }

    [[nodiscard]] WorldBakeResult bake() const {
        WorldRequest request;
        request.bake.budget = 64'000;
        request.bake.no_check = true;
        request.bake.mesh = (folder_.path() / "level.obj").string();
        request.folder = folder_.path() / "w";
        fs::create_directories(request.folder);
        Result<WorldBakeResult> result = bakeWorld(request);
        EXPECT_TRUE(result) << result.error().message;
        return std::move(*result);
    }

    [[nodiscard]] fs::path worldFile() const { return folder_.path() / "w" / kWorldFileName; }

    /// As people do in an editor.
    void edit(const std::function<void(World&)>& change) const {
        World world = *loadWorldFile(worldFile());
        change(world);
        const std::string text = worldText(world);
        ASSERT_TRUE(writeFile(worldFile(), std::as_bytes(std::span(text))));
    }

    [[nodiscard]] std::vector<std::byte> bytes() const { return *readFile(worldFile()); }

    TemporaryFolder folder_;
};

using Bodies = std::vector<std::pair<std::string, float>>;
Bodies frictionOf(const World& world) {
    Bodies bodies;
    for (const WorldBody& body : world.bodies) {
        bodies.emplace_back(body.node, body.friction);
    }
    return bodies;
}

/// A world as a bake makes it, of one collider, with a body for each node.
World placed(const std::vector<std::string>& nodes) {
    World world;
    world.colliders.push_back(
        {{"a.relief", std::string(32, '0'), 1}, "a", {glm::vec3(0.0F), glm::vec3(1.0F)}, {}});
    for (const std::string& node : nodes) {
        world.bodies.emplace_back().node = node;
    }
    return world;
}

TEST_F(WrittenByHand, ResponsesOfMaterialsStayByName) {
    writeLevel({{"door", "oak"}, {"floor", "stone"}});
    EXPECT_TRUE(bake().world.materials.empty());
    const std::vector<MaterialResponse> given{{"stone", 0.25F, {}, {}}, {"oak", {}, 0.5F, 1.0F}};
    edit([&](World& world) { world.materials = given; });
    const std::vector<std::byte> edited = bytes();
    const WorldBakeResult again = bake();
    EXPECT_TRUE(again.warnings.empty());
    EXPECT_EQ(again.countOf(WorldColliderState::kUpToDate), 2U);
    EXPECT_EQ(bytes(), edited);
    writeLevel({{"door", "oak"}, {"floor", "sand"}, {"roof", "slate"}});
    const WorldBakeResult changed = bake();
    EXPECT_EQ(changed.world.materials, (std::vector<MaterialResponse>{given[1]}));
    ASSERT_EQ(changed.warnings.size(), 1U);
    EXPECT_EQ(
        changed.warnings[0],
        "world.json: no collider has a material 'stone' any more; the response by that name is left out");
    EXPECT_TRUE(loadWorld(worldFile())) << "a reader refuses names of no material";
    EXPECT_TRUE(bake().warnings.empty());
}

TEST_F(WrittenByHand, BodiesKeepTheirResponsesByNode) {
    fs::create_directories(worldFile().parent_path());
    const auto replace = [&](World& world) {
        const auto replaced = replaceWorld(worldFile().parent_path(), world, {}, "level");
        EXPECT_TRUE(replaced) << replaced.error().message;
        return replaced->warnings;
    };
    World world = placed({"door", "gate", "gate", "floor"});
    EXPECT_TRUE(replace(world).empty());
    edit([](World& edited) {
        for (std::size_t i = 0; i < 4; ++i) {
            edited.bodies[i].friction = 0.25F * static_cast<float>(i);
        }
        edited.bodies[3].restitution = 0.5F;
    });
    // One after the other, wherever they are now.
    world = placed({"roof", "floor", "gate", "gate", "door"});
    EXPECT_TRUE(replace(world).empty());
    EXPECT_EQ(frictionOf(world),
              (Bodies{{"roof", 0.0F}, {"floor", 0.75F}, {"gate", 0.25F}, {"gate", 0.5F}, {"door", 0.0F}}));
    EXPECT_EQ(world.bodies[1].restitution, 0.5F);
    EXPECT_EQ(frictionOf(*loadWorldFile(worldFile())), frictionOf(world));
    // Of three gates nobody knows which are those two; a node that never had a response is not missed.
    world = placed({"gate", "gate", "gate"});
    const std::vector<std::string> warnings = replace(world);
    EXPECT_EQ(frictionOf(world), (Bodies{{"gate", 0.0F}, {"gate", 0.0F}, {"gate", 0.0F}}));
    EXPECT_EQ(warnings,
              std::vector<std::string>{"world.json: the bodies of 'floor', 'gate' are gone or others; their "
                                       "restitution and friction are left out"});
    // Alike, they are those of any number, such as tiles.
    edit([](World& edited) {
        for (WorldBody& body : edited.bodies) {
            body.friction = 0.125F;
        }
    });
    world = placed({"gate", "gate"});
    EXPECT_TRUE(replace(world).empty());
    EXPECT_EQ(frictionOf(world), (Bodies{{"gate", 0.125F}, {"gate", 0.125F}}));
}

TEST_F(WrittenByHand, AFileThatCannotBeReadIsReplacedWithAWarning) {
    writeLevel({{"door", "oak"}, {"floor", "stone"}});
    static_cast<void>(bake());
    const std::vector<std::byte> first = bytes();
    std::vector<std::byte> damaged = first;
    damaged.push_back(std::byte{'x'});
    ASSERT_TRUE(writeFile(worldFile(), damaged));
    const WorldBakeResult again = bake();
    ASSERT_EQ(again.warnings.size(), 1U);
    EXPECT_NE(again.warnings[0].find("world.json"), std::string::npos) << again.warnings[0];
    EXPECT_NE(again.warnings[0].find("; it is replaced, without what was written into it by hand"),
              std::string::npos)
        << again.warnings[0];
    EXPECT_EQ(again.warnings[0].find('\n'), std::string::npos);
    EXPECT_EQ(bytes(), first);
}

}  // namespace
}  // namespace relief::test
