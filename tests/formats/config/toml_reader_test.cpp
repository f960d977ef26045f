// SPDX-License-Identifier: Apache-2.0
// Reads a table into a struct: every value form, and every error with its position and fix.
#include "formats/config/toml_reader.h"

#include <gtest/gtest.h>

#include <glm/vec3.hpp>
#include <string>

#include "tests/results.h"

namespace relief {
namespace {

enum class Form : std::uint8_t { kBall, kBox };

}  // namespace

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<Form>{"ball", "box"};

namespace {

struct Part {
    float weight = 1.0F;
};
void fields(FieldVisitor& visit, Part& part) {
    visit("weight", part.weight, {"Weight", "kg", {0.0, 10.0, false}, {}, {.required = true}});
}

struct Pull {
    float strength = 1.0F;
};
void fields(FieldVisitor& visit, Pull& pull) {
    visit("strength", pull.strength, {"Strength", {}, {}, {}, {.required = true, .not_zero = true}});
}

struct Thing {
    Form form = Form::kBall;
    float radius = 1.0F;
    std::optional<glm::vec3> side;
    std::uint32_t least = 1;
    std::uint32_t most = 1;
    float low = 0.0F;
    float high = 1.0F;
    bool has_speed = false;
    double speed = 0.0;
    glm::vec3 axis{0.0F, 1.0F, 0.0F};
    std::vector<Part> parts;
    std::uint32_t heavy = 0;
    std::filesystem::path file;
    std::string origin;
    std::string name;
    std::string name_origin;
    std::optional<Pull> pull;
};
void fields(FieldVisitor& visit, Thing& t) {
    visit("form", t.form, {"Form", {}, {}, {}, {.selects = true}});
    visit("radius", t.radius, {"Radius", {}, {0.0, 5.0}, {}, {.only = "ball"}});
    visit("side", t.side, {"Sides", {}, {0.0, 5.0}, {}, {.only = "box", .required = true, .chooses = true}});
    visit("count", FieldSpan{t.least, t.most}, {"Number", {}, {1.0, 9.0}});
    visit("range", FieldPair{t.low, t.high}, {"Range", "[low, high] m"});
    visit("speed", FieldMaybe{t.speed, t.has_speed},
          {"Speed", {}, {}, {}, {.needs = "axis", .not_zero = true}});
    visit("axis", t.axis, {"Axis", {}, {}, {}, {.unit_length = true}});
    visit("part", t.parts, {"Parts", {}, {}, {}, {.most = 2}});
    visit("heavy", t.heavy, {"The heaviest", {}, {}, {}, {.instead_of = "count", .index_of = "part"}});
    visit("file", FieldPlaced{t.file, t.origin}, {"File"});
    visit("name", FieldPlaced{t.name, t.name_origin}, {"Name"});
    visit("pull", t.pull, {"Pull"});
}
std::optional<FieldFault> check(Thing& thing, const GivenFields& given) {
    if (given("part[1].weight") && thing.parts[1].weight > thing.parts[0].weight) {
        return FieldFault{"part[1].weight", "is above the first; order the parts"};
    }
    return std::nullopt;
}

Result<Thing> read(const std::string& text) {
    Thing thing;
    RELIEF_TRY(readTomlFile(text, {"f.toml", "dir", {}, "thing", nullptr},
                            [&](const TomlValue& top) { readToml(top, thing); }));
    return thing;
}

std::string error(const std::string& text) {
    const auto thing = read(text);
    return thing ? "" : thing.error().message;
}

TEST(TomlReader, ReadsEveryForm) {
    const auto thing = required(
        read("side = [1, 2, 3]\ncount = [2, 4]\nrange = [-1, 0.5]\nspeed = 3\naxis = [0, 0, -2]\nfile = "
             "\"a.obj\"\n"
             "name = \"a\"\n[[part]]\nweight = 2\n[[part]]\nweight = 1e-60\n"));
    EXPECT_EQ(thing.form, Form::kBox) << "read from its side length";
    EXPECT_EQ(*thing.side, glm::vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(thing.least, 2U);
    EXPECT_EQ(thing.most, 4U);
    EXPECT_EQ(thing.low, -1.0F);
    EXPECT_EQ(thing.high, 0.5F);
    EXPECT_TRUE(thing.has_speed);
    EXPECT_EQ(thing.axis, glm::vec3(0.0F, 0.0F, -1.0F));
    EXPECT_EQ(thing.file, std::filesystem::path("dir/a.obj"));
    EXPECT_EQ(thing.origin, "f.toml:6:8");
    EXPECT_EQ(thing.name + " " + thing.name_origin, "a f.toml:7:8");
    ASSERT_EQ(thing.parts.size(), 2U);
    EXPECT_GT(thing.parts[1].weight, 0.0F) << "positive in the file, positive as a float";
    EXPECT_EQ(read("count = 3\n")->most, 3U);
    EXPECT_FALSE(read("")->has_speed);
}

TEST(TomlReader, Errors) {
    EXPECT_EQ(error("fomr = \"box\"\nradius = 9\n"),
              "f.toml:1:1: unknown table 'fomr'; did you mean 'form'?");
    EXPECT_EQ(error("radius = 9\n"), "f.toml:1:10: radius = 9 is out of range; choose 0 to 5");
    EXPECT_EQ(error("radius = \"1\"\n"), "f.toml:1:10: radius must be a number");
    EXPECT_EQ(error("form = \"bal\"\n"), "f.toml:1:8: form = 'bal' is unknown; did you mean 'ball'?");
    EXPECT_EQ(error("form = \"box\"\n"), "f.toml:1:8: form = \"box\" also requires side");
    EXPECT_EQ(error("side = [1, 1, 1]\nradius = 2\n"),
              "f.toml:2:10: radius has no effect for form = \"box\"; remove it, or choose form = \"ball\"");
    EXPECT_EQ(error("count = [4, 2]\n"), "f.toml:1:9: count has a minimum above its maximum; swap them");
    EXPECT_EQ(error("range = [4]\n"), "f.toml:1:9: range must be two numbers [low, high]");
    EXPECT_EQ(error("speed = 1\n"),
              "f.toml:1:9: speed has no effect without axis; add axis, or remove speed");
    EXPECT_EQ(error("axis = [1, 0, 0]\nspeed = 0\n"),
              "f.toml:2:9: speed has no effect if it is 0; use another number, or remove it");
    EXPECT_EQ(error("pull = { strength = -1e-60 }\n"),
              "f.toml:1:21: pull.strength has no effect if it is 0; use another number, or remove the table");
    EXPECT_EQ(error("axis = [0, 0, 0]\n"),
              "f.toml:1:8: axis has no direction; use a nonzero vector such as [0, 1, 0]");
    EXPECT_EQ(error("heavy = 0\ncount = 1\n"), "f.toml:1:9: heavy and count exclude each other; remove one");
    EXPECT_EQ(error("[[part]]\n"), "f.toml:1:1: part.weight is missing; add it: Weight, kg");
    EXPECT_EQ(error("heavy = 1\n[[part]]\nweight = 1\n"),
              "f.toml:1:9: heavy = 1 is not one of the 1 parts; the first is 0");
    EXPECT_EQ(error("[[part]]\nweight = 1\n[[part]]\nweight = 2\n"),
              "f.toml:4:10: part.weight is above the first; order the parts");
    EXPECT_EQ(error("part = [{ weight = 1 }, { weight = 1 }, { weight = 1 }]\n"),
              "f.toml:1:41: there are 3 [[part]] tables; at most 2 are allowed");
    EXPECT_EQ(error("file = \"../a\"\n").substr(0, 22), "f.toml:1:8: file = '..");
    EXPECT_NE(error("form = \n").find("f.toml:1:"), std::string::npos);
}

}  // namespace
}  // namespace relief
