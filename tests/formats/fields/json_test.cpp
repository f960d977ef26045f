// JSON and its schema from one description of a struct.
#include "formats/fields/json.h"

#include <gtest/gtest.h>

namespace relief {

enum class Mood { kCalm, kWild };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Mood>{"calm", "wild"};

namespace {

struct Leaf {
    float size = 0.1F;
    std::optional<std::uint32_t> count;
};

template <class Visitor, FieldsOf<Leaf> L>
void fields(Visitor& visit, L& leaf) {
    visit("size", leaf.size, {.help = "Longest side", .unit = "m", .range = {0.0, 10.0, false}});
    visit("count", leaf.count, {.help = "Neighbours"});
}

struct Tree {
    std::string name = "oak";
    Mood mood = Mood::kWild;
    glm::vec3 at{1.0F, 2.0F, 0.5F};
    std::vector<Leaf> leaves{Leaf{}};
};

template <class Visitor, FieldsOf<Tree> T>
void fields(Visitor& visit, T& tree) {
    visit("name", tree.name, {.help = "Species"});
    visit("mood", tree.mood, {.help = "Of its keeper"});
    visit("at", tree.at, {.help = "Foot", .range = within(100.0)});
    visit("leaves", tree.leaves, {.help = "The largest first"});
    visit("crowded", tree.leaves.size() > 2, {.help = "More than two leaves"});
}

TEST(FieldsAsJson, WritesMembersInTheOrderOfTheVisits) {
    EXPECT_EQ(
        jsonOf(Tree{}).dump(),
        R"({"name":"oak","mood":"wild","at":[1.0,2.0,0.5],"leaves":[{"size":0.1,"count":null}],"crowded":false})");
}

TEST(FieldsAsJson, SchemaIsClosedAndHasRangesAndWords) {
    const Json schema = schemaOf(Tree{});
    EXPECT_EQ(schema["additionalProperties"], false);
    EXPECT_EQ(schema["required"], Json::array({"name", "mood", "at", "leaves", "crowded"}));
    const Json& leaf = schema["properties"]["leaves"]["items"]["properties"];
    EXPECT_EQ(
        leaf["size"],
        Json::parse(
            R"({"description":"Longest side, m","type":"number","exclusiveMinimum":0.0,"maximum":10.0})"));
    EXPECT_EQ(leaf["count"],
              Json::parse(R"({"description":"Neighbours","type":["integer","null"],"minimum":0})"));
    EXPECT_EQ(schema["properties"]["mood"]["enum"], Json::array({"calm", "wild"}));
    EXPECT_EQ(schema["properties"]["at"]["items"]["minimum"], -100.0);
    EXPECT_EQ(schema["properties"]["crowded"]["type"], "boolean");
}

TEST(Words, AreFoundAndOthersAreNot) {
    EXPECT_EQ(fromWord<Mood>("wild"), Mood::kWild);
    EXPECT_EQ(fromWord<Mood>("Wild"), std::nullopt);
    EXPECT_FALSE(FieldRange({0.0, 1.0, false}).holds(0.0));
    EXPECT_FALSE(FieldRange{}.holds(std::nan("")));
}

}  // namespace
}  // namespace relief
