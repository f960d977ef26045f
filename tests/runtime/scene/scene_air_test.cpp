// SPDX-License-Identifier: Apache-2.0
// The scene's air and fields: the effect of their keys, and their part of the report.
#include <gtest/gtest.h>

#include <string>

#include "formats/fields/json.h"
#include "runtime/player/report.h"
#include "tests/runtime/scene/scene_text.h"

namespace relief {
namespace {

const std::string kBoundingBox = "box_min = [0, 0, 0]\nbox_max = [1, 2, 3]\n";

TEST(SceneAir, KeysSetTheAir) {
    const Scene scene = sceneWith(
        "[[attractor]]\nposition = [1, 2, 3]\nstrength = 4\nradius = 0.5\n"
        "[[attractor]]\nposition = [0, 0, 0]\nstrength = -1\nradius = 1\nfalloff = 0\nreach = 2.5\n"
        "[[vortex]]\ncenter = [1, 0, 1]\naxis = [0, 0, -1e-20]\nstrength = 3\nradius = 0.25\nfalloff = 2\n"
        "[curl_noise]\namplitude = 0.5\nscale = 2\noctaves = 4\ndrift = 2000\nseed = 4294967295\n"
        "[flow]\nraw = \"f.raw\"\nsize = [512, 1, 8]\ncomponents = 2\noutside = \"edge\"\ngain = -2\n" +
        kBoundingBox + "[forces]\nwind = [1, 0, 0]\nviscosity = 1.8e-5\n");
    EXPECT_EQ(scene.air.attractors,
              (std::vector<Attractor>{{{1, 2, 3}, 4.0F, 0.5F}, {{0, 0, 0}, -1.0F, 1.0F, 0, 2.5F}}));
    EXPECT_EQ(scene.air.vortices,  // the axis has unit length
              (std::vector<Vortex>{{{1, 0, 1}, {0, 0, -1}, 3.0F, 0.25F, 2}}));
    EXPECT_EQ(scene.air.curl_noise, (CurlNoise{0.5F, 2.0F, 4, 2000.0F, 4294967295U}));
    EXPECT_EQ(scene.flow->origin, "dir/scene.toml:26:7: flow.raw: ");
    EXPECT_EQ(scene.flow->size, (std::array<std::uint32_t, 3>{512, 1, 8}));
    EXPECT_EQ(scene.flow->components, 2U);
    EXPECT_EQ(scene.flow->outside, FlowOutside::kEdge);
    EXPECT_EQ(scene.flow->gain, -2.0F);
    EXPECT_EQ(scene.air.wind, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.air.viscosity, 1.8e-5F);
    EXPECT_TRUE(checkAir(scene.air));
    // The runtime accepts the smallest values that the file may contain.
    EXPECT_TRUE(checkAir(sceneWith("[curl_noise]\namplitude = 1e-300\nscale = 1e-300\n").air));
}

TEST(SceneAir, ReportListsTheActiveAir) {
    const auto report = [&](const std::string& more) {
        const auto scene = withDefaults(sceneWith(more), unitBounds());
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
        kBoundingBox + "[curl_noise]\namplitude = 0.3\nscale = 2\n");
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
    EXPECT_EQ(all.find("drag"), std::string::npos) << "viscosity replaces it";
}

}  // namespace
}  // namespace relief
