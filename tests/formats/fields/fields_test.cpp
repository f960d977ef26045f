// SPDX-License-Identifier: Apache-2.0
// Output derived from fields(): JSON, schemas, tables, dictionaries.
#include "formats/fields/json_value.h"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>

#include "formats/fields/reference.h"

namespace relief {

enum class Mood { kCalm, kWild };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Mood>{"calm", "wild"};

namespace {

struct Leaf {
    float size = 0.1F;
    std::optional<std::uint32_t> count;
};

void fields(FieldVisitor& visit, const Leaf& leaf) {
    visit("size", leaf.size, {.help = "Longest side", .unit = "m", .range = {0.0, 10.0, false}});
    visit("count", leaf.count, {.help = "Neighbours"});
}

struct Tree {
    std::string name = "oak";
    Mood mood = Mood::kWild;
    glm::vec3 at{1.0F, 2.0F, 0.5F};
    std::vector<Leaf> leaves{Leaf{}};
};

void fields(FieldVisitor& visit, const Tree& tree) {
    visit("name", tree.name, {.help = "Species"});
    visit("mood", tree.mood, {.help = "Of its keeper"});
    visit("at", tree.at, {.help = "Foot", .range = within(100.0)});
    visit("leaves", tree.leaves, {.help = "The largest first"});
    visit("crowded", tree.leaves.size() > 2, {.help = "More than two leaves"});
}

TEST(FieldsAsJson, WritesMembersInVisitOrder) {
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

/// A report whose value is either a leaf that was found or one that was not.
struct Search {
    bool found = true;
    std::string why;

    [[nodiscard]] static std::vector<Search> kinds() { return {{true, ""}, {false, "dry"}}; }
};

void fields(FieldVisitor& visit, const Search& search) {
    visit("found", search.found,
          {.help = "Success", .words = search.found ? kWords<"true"> : kWords<"false">});
    if (search.found) {
        const auto leaf = [&](FieldVisitor& visit_leaf) {
            visit_leaf("size", 2.0, {"Longest side", "m", kFromZero});
        };
        visit("leaf", groupIf(true, leaf), {"The leaf; null if it fell"});
        visit("names", std::vector<std::string>{},
              {.help = "Its names", .pattern = "^[a-z]+$", .left_out = true});
        visit("sizes", std::array{1.5F, 2.0F}, {"Width and height", "m"});
    } else {
        visit("why", search.why, {"Reason"});
    }
}

TEST(FieldsAsJson, ReportKindsHaveTheirOwnFields) {
    EXPECT_EQ(jsonOf(Search{}).dump(), R"({"found":true,"leaf":{"size":2.0},"sizes":[1.5,2.0]})");
    EXPECT_EQ(jsonOf(Search{false, "dry"}).dump(), R"({"found":false,"why":"dry"})");
    const Json kinds = schemaOf(Search{})["anyOf"];
    ASSERT_EQ(kinds.size(), 2U);
    EXPECT_EQ(kinds[0]["required"], Json::array({"found", "leaf", "sizes"}));
    EXPECT_EQ(kinds[1]["required"], Json::array({"found", "why"}));
    const Json& found = kinds[0]["properties"];
    EXPECT_EQ(found["found"]["enum"], Json::array({true}));
    EXPECT_EQ(found["leaf"]["oneOf"][1], Json::parse(R"({"type":"null"})"));
    EXPECT_EQ(found["names"]["minItems"], 1) << "empty lists are omitted";
    EXPECT_EQ(found["names"]["items"]["pattern"], "^[a-z]+$");
    EXPECT_EQ(found["sizes"]["maxItems"], 2);
}

TEST(Words, AreFoundByName) {
    EXPECT_EQ(fromWord<Mood>("wild"), Mood::kWild);
    EXPECT_EQ(fromWord<Mood>("Wild"), std::nullopt);
    EXPECT_FALSE(FieldRange({0.0, 1.0, false}).holds(0.0));
    EXPECT_FALSE(FieldRange{}.holds(std::nan("")));
}

struct Place {
    glm::vec3 at{0.0F};
};
void fields(FieldVisitor& visit, Place& place) {
    visit("at", place.at, {"Point", "[x, y, z]", within(1e9), {}, {.required = true}});
}

struct Described {
    float size = 0.5F;
    std::uint32_t least = 1;
    std::uint32_t most = 2;
    int power = 2;
    std::vector<Place> places;
};
void fields(FieldVisitor& visit, Described& thing) {
    visit("size", thing.size, {"Diameter", "m", {0.0, 1e6, false}, {}, {.needs = "count"}});
    visit("count", FieldSpan{thing.least, thing.most}, {"Number"});
    visit("power", thing.power, {"Exponent", {}, {0.0, 2.0}});
    visit("place", thing.places, {"Places", {}, {}, {}, {.most = 3}});
}

TEST(Reference, Markdown) {
    EXPECT_EQ(markdownTable(referenceOf<Described>()),
              "| key | meaning | default | range |\n| --- | --- | --- | --- |\n"
              "| `size` | Diameter, m; needs `count` | 0.5 | above 0 … 10⁶ |\n"
              "| `count` | Number | [1, 2] |  |\n"
              "| `power` | Exponent | 2 | 0, 1, 2 |\n");
    static constexpr std::array<std::string_view, 1> kNames{"place"};
    EXPECT_EQ(markdownTables(referenceOf<Described>(), kNames),
              "| key | meaning | default | range |\n| --- | --- | --- | --- |\n"
              "| `[[place]]` `at` | Point, [x, y, z] | required | ±10⁹ |\n");
}

TEST(Reference, SchemaAndDictionary) {
    const Json schema = fileSchema(referenceOf<Described>(), "#");
    EXPECT_EQ(schema["required"], Json::array());
    EXPECT_EQ(schema["properties"]["place"]["items"]["required"], Json::array({"at"}));
    EXPECT_EQ(schema["properties"]["size"]["exclusiveMinimum"], 0.0);
    EXPECT_EQ(schema["properties"]["count"]["oneOf"].size(), 2U);
    EXPECT_NE(fuzzDictionary(referenceOf<Described>()).find("\"[[place]]\\x0a\""), std::string::npos);
}

}  // namespace
}  // namespace relief
