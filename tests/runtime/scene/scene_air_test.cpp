// The scene's keys of air and fields: what they set, both ends of their ranges, and every mistake with its
// line and column.
#include <gtest/gtest.h>

#include <string>

#include "formats/fields/json.h"
#include "runtime/player/report.h"
#include "runtime/scene/scene.h"
#include "runtime/scene/scene_parser.h"
#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

const std::string kHead = "[collider]\nfile = \"a.relief\"\n";

Result<Scene> parse(const std::string& more) {
    return parseScene(kHead + more, "dir/scene.toml");
}

Scene good(const std::string& more) {
    const auto scene = parse(more);
    EXPECT_TRUE(scene) << more << "\n" << scene.error().message;
    return scene.value_or(Scene{});
}

/// `more` starts at line 3.
void expectError(const std::string& more, const std::string& place, const std::string& part) {
    expectSceneError(kHead + more, "dir/scene.toml:" + place + ": ", part);
}

const std::string kBox = "box_min = [0, 0, 0]\nbox_max = [1, 2, 3]\n";

TEST(SceneAir, WithoutItsTablesThereIsNone) {
    const Scene scene = good("");
    EXPECT_TRUE(scene.air.attractors.empty());
    EXPECT_TRUE(scene.air.vortices.empty());
    EXPECT_FALSE(scene.air.curl_noise);
    EXPECT_FALSE(scene.air.viscosity);
    EXPECT_FALSE(scene.flow);
    EXPECT_EQ(scene.air.wind, glm::vec3(0.0F));
}

TEST(SceneAir, AttractorsAndVorticesInTheirOrder) {
    const Scene scene = good(
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.5\n"
        "[[attractor]]\nposition = [0, 0, 0]\nstrength = -1\nradius = 1\nfalloff = 0\nreach = 2.5\n"
        "[[vortex]]\ncenter = [1, 0, 1]\nstrength = 3\nradius = 0.25\n"
        "[[vortex]]\ncenter = [1, 0, 1]\naxis = [0, 0, -1e-20]\nstrength = 3\nradius = 0.25\nfalloff = 2\n"
        "[forces]\nwind = [1, 0, 0]\n");
    ASSERT_EQ(scene.air.attractors.size(), 2U);
    EXPECT_EQ(scene.air.attractors[0].position, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.air.attractors[0].strength, 4.0F);
    EXPECT_EQ(scene.air.attractors[0].radius, 0.5F);
    EXPECT_EQ(scene.air.attractors[0].falloff, 2);
    EXPECT_EQ(scene.air.attractors[0].reach, Attractor{}.reach);
    EXPECT_EQ(scene.air.attractors[1].strength, -1.0F);
    EXPECT_EQ(scene.air.attractors[1].falloff, 0);
    EXPECT_EQ(scene.air.attractors[1].reach, 2.5F);
    ASSERT_EQ(scene.air.vortices.size(), 2U);
    EXPECT_EQ(scene.air.vortices[0].axis, glm::vec3(0, 1, 0));
    EXPECT_EQ(scene.air.vortices[0].falloff, 1);
    EXPECT_EQ(scene.air.vortices[1].axis, glm::vec3(0, 0, -1)) << "of unit length";
    EXPECT_EQ(scene.air.vortices[1].falloff, 2);
    EXPECT_EQ(scene.air.wind, glm::vec3(1, 0, 0));
    EXPECT_TRUE(checkAir(scene.air));
}

TEST(SceneAir, Flows) {
    Scene scene = good("[flow]\nraw = \"f.raw\"\nsize = [512, 1, 8]\n" + kBox);
    ASSERT_TRUE(scene.flow);
    EXPECT_EQ(scene.flow->path, std::filesystem::path("dir/f.raw"));
    EXPECT_EQ(scene.flow->origin, "dir/scene.toml:4:7: flow.raw: ");
    EXPECT_EQ(scene.flow->size, (std::array<std::uint32_t, 3>{512, 1, 8}));
    EXPECT_EQ(scene.flow->components, 3U);
    EXPECT_EQ(scene.flow->box_max, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.flow->outside, FlowOutside::kZero);
    EXPECT_EQ(scene.flow->gain, 1.0F);
    scene = good(
        "[flow]\nraw = \"f.raw\"\nsize = [1, 1, 1]\ncomponents = 2\noutside = \"edge\"\ngain = -2\n" + kBox);
    EXPECT_EQ(scene.flow->components, 2U);
    EXPECT_EQ(scene.flow->outside, FlowOutside::kEdge);
    EXPECT_EQ(scene.flow->gain, -2.0F);
}

TEST(SceneAir, CurlNoiseAndViscosity) {
    Scene scene = good("[curl_noise]\namplitude = 0.5\nscale = 2\n");
    ASSERT_TRUE(scene.air.curl_noise);
    EXPECT_EQ(scene.air.curl_noise->amplitude, 0.5F);
    EXPECT_EQ(scene.air.curl_noise->scale, 2.0F);
    EXPECT_EQ(scene.air.curl_noise->octaves, 2);
    EXPECT_EQ(scene.air.curl_noise->drift, 0.0F);
    EXPECT_EQ(scene.air.curl_noise->seed, 1U);
    scene = good(
        "[curl_noise]\namplitude = 0.5\nscale = 2\noctaves = 4\ndrift = 2000\nseed = 4294967295\n"
        "[forces]\nviscosity = 1.8e-5\n");
    EXPECT_EQ(scene.air.curl_noise->octaves, 4);
    EXPECT_EQ(scene.air.curl_noise->drift, 2000.0F);
    EXPECT_EQ(scene.air.curl_noise->seed, 4294967295U);
    EXPECT_EQ(scene.air.viscosity, 1.8e-5F);
    EXPECT_TRUE(checkAir(scene.air));
    // The smallest that the file may say is still taken by the runtime.
    EXPECT_TRUE(checkAir(good("[curl_noise]\namplitude = 1e-300\nscale = 1e-300\n").air));
}

TEST(SceneAir, MistakesOfFieldsAreNamed) {
    const std::string attractor = "[[attractor]]\nposition = [0, 0, 0]\nstrength = 1\nradius = 1\n";
    const std::string vortex = "[[vortex]]\ncenter = [0, 0, 0]\nstrength = 1\nradius = 1\n";
    expectError("[attractor]\nstrength = 1\n", "3:1", "[[attractor]]");
    expectError("[[attractor]]\nstrength = 1\nradius = 1\n", "3:1", "attractor.position is missing");
    expectError("[[attractor]]\nposition = [0, 0, 0]\nradius = 1\n", "3:1", "strength is missing");
    expectError("[[attractor]]\nposition = [0, 0, 0]\nstrength = 1\n", "3:1", "radius is missing");
    expectError("[[attractor]]\nposition = [0, 0, 0]\nstrength = 0\nradius = 1\n", "5:12", "does nothing");
    expectError("[[attractor]]\nposition = [0, 0, 0]\nstrength = nan\nradius = 1\n", "5:12", "out of range");
    expectError("[[attractor]]\nposition = [0, 0, 0]\nstrength = 1\nradius = 0\n", "6:10", "above 0");
    expectError(attractor + "falloff = 3\n", "7:11", "0 to 2");
    expectError(attractor + "falloff = 1.5\n", "7:11", "whole number");
    expectError(attractor + "reach = 0\n", "7:9", "above 0");
    expectError(attractor + "raech = 1\n", "7:1", "reach");
    std::string nine;
    for (int i = 0; i < 9; ++i) {
        nine += attractor;
    }
    expectError(nine, "35:1", "9 of [[attractor]]");
    expectError("[[vortex]]\nstrength = 1\nradius = 1\n", "3:1", "vortex.center is missing");
    expectError(vortex + "axis = [0, 0, 0]\n", "7:8", "no direction");
    expectError(vortex + "reach = 1\n", "7:1", "unknown key");
}

TEST(SceneAir, MistakesOfAirAreNamed) {
    expectError("[flow]\n" + kBox, "3:1", "flow.raw is missing");
    expectError("[flow]\nraw = \"\"\nsize = [1, 1, 1]\n" + kBox, "4:7", "names no file");
    expectError("[flow]\nfile = \"a.exr\"\n" + kBox, "4:1", "unknown key");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\nbox_min = [0, 0, 0]\n", "3:1",
                "flow.box_max is missing");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\nbox_min = [0, 2, 0]\nbox_max = [1, 2, 3]\n",
                "6:11", "y axis");
    expectError("[flow]\nraw = \"a.raw\"\n" + kBox, "3:1", "flow.size is missing");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1]\n" + kBox, "5:8", "three whole numbers");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1, 513]\n" + kBox, "5:15", "1 to 512");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [512, 512, 65]\n" + kBox, "5:8", "bytes");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\ncomponents = 4\n" + kBox, "6:14", "2 to 3");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\noutside = \"wrap\"\n" + kBox, "6:11", "\"edge\"");
    expectError("[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\ngain = 0\n" + kBox, "6:8", "does nothing");
    expectError("[forces]\ndrag = 0\n[flow]\nraw = \"a.raw\"\nsize = [1, 1, 1]\n" + kBox, "5:1",
                "forces.drag");
    expectError("[curl_noise]\nscale = 1\n", "3:1", "amplitude is missing");
    expectError("[curl_noise]\namplitude = 1\n", "3:1", "scale is missing");
    expectError("[curl_noise]\namplitude = 0\nscale = 1\n", "4:13", "above 0");
    expectError("[curl_noise]\namplitude = 1\nscale = 1\noctaves = 5\n", "6:11", "1 to 4");
    expectError("[curl_noise]\namplitude = 1\nscale = 1\ndrift = 1001\n", "6:9", "lower it");
    expectError("[curl_noise]\namplitude = 1\nscale = 1\nseed = -1\n", "6:8", "out of range");
    expectError("[curl_noise]\namplitude = 1\nscale = 1\n[forces]\nviscosity = 0\n", "3:1",
                "forces.viscosity");
    expectError("[forces]\nviscosity = 1\ndrag = 2\n", "4:13", "exclude each other");
    expectError("[forces]\nviscosity = -1\n", "4:13", "out of range");
    expectError("[forces]\nviscosity = 0\nwind = [1, 0, 0]\n", "5:8", "forces.viscosity is 0");
    expectError("[flwo]\n", "3:2", "'flow'");
}

/// Every key and default of the air, and none of what the scene does not have.
TEST(SceneAir, TheReportHasWhatThePlayerPlays) {
    Bounds bounds;
    bounds.add({0.0F, 0.0F, 0.0F});
    bounds.add({1.0F, 1.0F, 1.0F});
    const auto report = [&](const std::string& more) {
        const auto scene = withDefaults(good(more), bounds);
        EXPECT_TRUE(scene);
        PlayerReport result;
        result.scene = scene.value_or(Scene{});
        std::string json = jsonTextOf(result);
        std::erase_if(json, [](char c) { return c == ' ' || c == '\n'; });
        return json;
    };
    const std::string none = report("");
    for (const char* key : {"attractor", "vortex", "flow", "curl_noise", "viscosity"}) {
        EXPECT_EQ(none.find(key), std::string::npos) << key;
    }
    const std::string all = report(
        "[forces]\nviscosity = 0.1\n"
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.1\n"
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.1\nreach = 2\n"
        "[[vortex]]\ncenter = [1, 0, 1]\nstrength = 3\nradius = 0.25\n"
        "[flow]\nraw = \"f.raw\"\nsize = [3, 2, 1]\n" +
        kBox + "[curl_noise]\namplitude = 0.3\nscale = 2\n");
    for (const char* part :
         {"\"viscosity\":0.1",
          "\"attractor\":[{\"position\":[1.0,2.0,3.0],\"strength\":4.0,\"radius\":0.1,\"falloff\":2},",
          "\"falloff\":2,\"reach\":2.0}]",
          "\"vortex\":[{\"center\":[1.0,0.0,1.0],\"axis\":[0.0,1.0,0.0],\"strength\":3.0,\"radius\":0.25,"
          "\"falloff\":1}]",
          "\"flow\":{\"raw\":\"dir/f.raw\",\"size\":[3,2,1],\"components\":3,\"box_min\":[0.0,0.0,0.0],"
          "\"box_max\":[1.0,2.0,3.0],\"outside\":\"zero\",\"gain\":1.0}",
          "\"curl_noise\":{\"amplitude\":0.3,\"scale\":2.0,\"octaves\":2,\"drift\":0.0,\"seed\":1}"}) {
        EXPECT_NE(all.find(part), std::string::npos) << part << "\n" << all;
    }
    EXPECT_EQ(all.find("drag"), std::string::npos) << "the viscosity takes its place";
}

}  // namespace
}  // namespace relief
