// SPDX-License-Identifier: Apache-2.0
#include "bake/views/map_spec.h"

#include <gtest/gtest.h>

#include "tests/results.h"

namespace relief {
namespace {

TEST(MapSpec, PatchesHaveOnlyBytes) {
    const MapSpec spec = required(parseMapSpec("patches:budget=250kB", kPaperDefaults));
    EXPECT_EQ(spec.format, MapFormat::kPatches);
    EXPECT_EQ(spec.bytes, 250'000U);
    EXPECT_EQ(spec.decode, Decode::kPlane);
    EXPECT_EQ(toString(spec), "patches:budget=250000");
    EXPECT_EQ(*parseMapSpec(toString(spec)), spec);
    EXPECT_EQ(toString(*parseMapSpec("patches")), "patches");
    EXPECT_EQ(toString(*parseMapSpec("patches:texel=0.01,budget=1MB")), "patches:budget=1000000,texel=0.01");
    for (const char* wrong :
         {"patches:size=64", "patches:dir=+x", "patches:decode=plane", "patches:box=tight",
          "patches:budget=1023", "patches:budget=1GB", "patches:budget=many", "patches:texel=0",
          "cube:texel=1", "cube:budget=1MB", "front-back:budget=1MB"}) {
        SCOPED_TRACE(wrong);
        expectError(parseMapSpec(wrong), ErrorCode::kUsage);
    }
}

TEST(MapSpecParser, ReadsEveryKey) {
    const MapSpec spec =
        required(parseMapSpec("fixed8:dir=-y,size=640x480,compare=greater,box=-1/-2/-3/1/2.5/3e1"));
    EXPECT_EQ(spec.format, MapFormat::kFixed8);
    EXPECT_EQ(spec.direction, glm::vec3(0, -1, 0));
    EXPECT_EQ(spec.width, 640U);
    EXPECT_EQ(spec.height, 480U);
    EXPECT_EQ(spec.compare, Compare::kGreater);
    ASSERT_TRUE(spec.box);
    EXPECT_EQ(spec.box->max, glm::vec3(1, 2.5F, 30));

    const MapSpec cube = required(parseMapSpec("cube:center=0/0.1/-2,size=64,compare=less"));
    EXPECT_EQ(cube.format, MapFormat::kCube8);
    EXPECT_EQ(cube.center, glm::vec3(0, 0.1F, -2));
    EXPECT_EQ(cube.width, 64U);
    EXPECT_EQ(cube.height, 64U);

    EXPECT_EQ(*parseMapSpec("float"), *parseMapSpec("float:dir=-z,box=tight"));
    EXPECT_EQ(parseMapSpec("front-back:dir=x")->direction, glm::vec3(1, 0, 0));
    EXPECT_EQ(parseMapSpec("front-back:dir=1/-2/0.5")->direction, glm::vec3(1, -2, 0.5F));
    EXPECT_FALSE(parseMapSpec("float")->compare) << "the baker chooses";
    EXPECT_FALSE(parseMapSpec("float")->up) << "view.h chooses";
    EXPECT_EQ(parseMapSpec("float:dir=+x,up=-z")->up, glm::vec3(0, 0, -1));
    EXPECT_EQ(parseMapSpec("front-back:up=1/2/-0.5,dir=+x")->up, glm::vec3(1, 2, -0.5F));
}

TEST(MapSpecParser, MissingKeysUseTheDefaults) {
    for (const char* format : {"float", "fixed8", "front-back", "cube"}) {
        EXPECT_EQ(parseMapSpec(format)->decode, Decode::kPlane) << format;
        EXPECT_EQ(parseMapSpec(format, kPaperDefaults)->decode, Decode::kProjected) << format;
    }
    EXPECT_EQ(parseMapSpec("front-back")->format, MapFormat::kFrontBackFixed);
    EXPECT_EQ(parseMapSpec("front-back", kPaperDefaults)->format, MapFormat::kFrontBackHalf);
    // Explicit keys override the defaults.
    EXPECT_EQ(*parseMapSpec("front-back:depth=half,decode=projected"),
              *parseMapSpec("front-back:depth=half,decode=projected", kPaperDefaults));
    EXPECT_EQ(*parseMapSpec("front-back:depth=unorm16,decode=plane"),
              *parseMapSpec("front-back:depth=unorm16,decode=plane", kPaperDefaults));
}

TEST(MapSpecParser, SpecsRoundTripThroughText) {
    for (const std::string text :
         {"float:dir=+x,size=512x512,compare=less,decode=projected,box=tight",
          "fixed8:dir=1/2/0.25,size=3x16384,compare=greater,decode=plane,box=0/0/0/1/1/1",
          "front-back:dir=-y,size=7x9,depth=half,decode=projected,box=tight",
          "front-back:dir=-y,size=7x9,depth=unorm16,decode=plane,box=tight",
          "front-back:dir=1/2/3,up=0.1/-7/1e-20,size=7x9,depth=unorm16,decode=plane,box=tight",
          "float:dir=-y,up=+x,size=7x9,compare=less,decode=plane,box=tight",
          "front-back:dir=+x,size=64x32,depth=unorm16,decode=plane,box=tight",
          "cube:size=256,compare=less,center=0/0.1/0,decode=projected,box=tight",
          "cube:size=1,compare=greater,decode=plane,box=-1/-1/-1/0.1/1e+20/3"}) {
        const MapSpec spec = required(parseMapSpec(text));
        EXPECT_EQ(toString(spec), text);
        EXPECT_EQ(*parseMapSpec(toString(spec)), spec);
    }
    // Each setting has one text form.
    EXPECT_EQ(toString(*parseMapSpec("float:size=8,dir=-0/0/-1,compare=less")),
              toString(*parseMapSpec("float:compare=less,dir=-z,size=8x8")));
}

TEST(MapSpecParser, ErrorsNameTheFix) {
    struct Case {
        const char* text;
        ErrorCode code;
        const char* says;
    };
    constexpr ErrorCode kUsage = ErrorCode::kUsage;
    const Case cases[] = {
        {"", kUsage, "use one of float, fixed8, front-back, cube"},
        {"fixed8:depth=half", kUsage, "depth applies only to front-back"},
        {"front-back:depth=hlf", kUsage, "did you mean 'half'"},
        {"cube:decode=plan", kUsage, "did you mean 'plane'"},
        {"frontback", kUsage, "did you mean 'front-back'"},
        {"FLOAT", kUsage, "unknown format"},
        {"float:", kUsage, "unknown key ''"},
        {"float:sise=4", kUsage, "did you mean 'size'"},
        {"float:size", kUsage, "size has no value"},
        {"float:size=4,size=5", kUsage, "set twice"},
        {"float:size=0", kUsage, "at least 3"},
        {"cube:size=0", kUsage, "at least 1"},
        {"cube:size=4x5", kUsage, "square"},
        {"float:size=-4", kUsage, "N or WxH"},
        {"float:size=1e3", kUsage, "N or WxH"},
        {"float:size=16385", ErrorCode::kLimit, "16384"},
        {"float:size=8x99999999999999999999999999", ErrorCode::kLimit, "16384"},
        {"float:dir=0/0/0", kUsage, "not 0/0/0"},
        {"float:dir=-0/0/-0", kUsage, "not 0/0/0"},
        {"float:dir=nan/0/1", kUsage, "a/b/c"},
        {"float:dir=1e99/0/0", kUsage, "a/b/c"},
        {"cube:dir=+x", kUsage, "does not apply to a cube"},
        {"front-back:compare=less", kUsage, "remove compare"},
        {"fixed8:compare=both", kUsage, "less or greater"},
        {"float:compare=lesser", kUsage, "did you mean 'less'"},
        {"float:center=0/0/0", kUsage, "applies only to a cube"},
        {"cube:center=0/0", kUsage, "three numbers"},
        {"cube:center=0/0/0,box=0/0/0/1/1/1", kUsage, "remove center"},
        {"float:box=0/0/0/1/1", kUsage, "two corners"},
        {"float:box=0/0/0/0/1/1", kUsage, "x0 < x1"},
        {"float:box=tigt", kUsage, "tight"},
        {"float:dir=\x1b[31m", kUsage, "dir is"},
        {"cube:up=+y", kUsage, "does not apply to a cube"},
        {"float:up=high", kUsage, "up is 'high'"},
        {"float:dir=-z,up=+z", kUsage, "parallel"},
        {"float:up=-3/-2/-1,dir=3/2/1", kUsage, "parallel"},
        {"float:dir=1e-38/2e-38/3e-38,up=1e38/2e38/3.00001e38", kUsage, "parallel"},
    };
    for (const Case& c : cases) {
        const Result<MapSpec> spec = parseMapSpec(c.text);
        expectError(spec, c.code, c.says);
        EXPECT_TRUE(!spec && spec.error().message.starts_with("--map") &&
                    spec.error().message.find('\x1b') == std::string::npos);
    }
}

}  // namespace
}  // namespace relief
