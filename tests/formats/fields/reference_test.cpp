// The tables, types and schemas that are derived from fields().
#include "formats/fields/reference.h"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>

namespace relief {
namespace {

struct Place {
    glm::vec3 at{0.0F};
};
void fields(FieldVisitor& visit, Place& place) {
    visit("at", place.at, {"Point", "[x, y, z]", within(1e9), {}, {.required = true}});
}

struct Thing {
    float size = 0.5F;
    std::uint32_t least = 1;
    std::uint32_t most = 2;
    std::vector<Place> places;
};
void fields(FieldVisitor& visit, Thing& thing) {
    visit("size", thing.size, {"Diameter", "m", {0.0, 1e6, false}, {}, {.needs = "count"}});
    visit("count", FieldSpan{thing.least, thing.most}, {"Number"});
    visit("place", thing.places, {"Places", {}, {}, {}, {.most = 3}});
}

TEST(Reference, Markdown) {
    EXPECT_EQ(markdownTable(referenceOf<Thing>()),
              "| key | meaning | default | range |\n| --- | --- | --- | --- |\n"
              "| `size` | Diameter, m; needs `count` | 0.5 | above 0 … 10⁶ |\n"
              "| `count` | Number | [1, 2] |  |\n");
    static constexpr std::array<std::string_view, 1> kNames{"place"};
    EXPECT_EQ(markdownTables(referenceOf<Thing>(), kNames),
              "| key | meaning | default | range |\n| --- | --- | --- | --- |\n"
              "| `[[place]]` `at` | Point, [x, y, z] | required | ±10⁹ |\n");
}

TEST(Reference, SchemaAndDictionary) {
    const Json schema = fileSchema(referenceOf<Thing>());
    EXPECT_EQ(schema["required"], Json::array());
    EXPECT_EQ(schema["properties"]["place"]["items"]["required"], Json::array({"at"}));
    EXPECT_EQ(schema["properties"]["size"]["exclusiveMinimum"], 0.0);
    EXPECT_EQ(schema["properties"]["count"]["oneOf"].size(), 2U);
    EXPECT_NE(fuzzDictionary(referenceOf<Thing>()).find("\"[[place]]\\x0a\""), std::string::npos);
}

}  // namespace
}  // namespace relief
