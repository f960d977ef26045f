// The scene's colliders that deform: what is read, what is filled in, and every mistake with its place.
#include "runtime/scene/scene_live.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include "runtime/scene/scene.h"
#include "runtime/scene/scene_parser.h"
#include "tests/runtime/scene/scene_error.h"

namespace relief {
namespace {

const std::string kHead = "[collider]\nmesh = \"a.obj\"\n";

/// The lines after the head start at line 3.
void expectError(const std::string& more, const std::string& place, const std::string& part) {
    expectSceneError(kHead + more, "dir/scene.toml:" + place + ": ", part);
}

SceneLive good(const std::string& deform) {
    const auto scene = parseScene(kHead + deform, "dir/scene.toml");
    EXPECT_TRUE(scene) << scene.error().message;
    if (!scene || !scene->colliders.front().live) {
        ADD_FAILURE() << "not live";
        return {};
    }
    EXPECT_EQ(scene->colliders.front().path, "dir/a.obj");
    EXPECT_FALSE(scene->colliders.front().posed);
    EXPECT_EQ(scene->colliders.front().resolution,
              deform.find("resolution") == std::string::npos ? 256U : 100U);
    return *scene->colliders.front().live;
}

TEST(SceneLive, Keys) {
    const SceneLive live = good(
        "deform = { amplitude = 0.2, frequency = 0.5, phase = 180, wavelength = 3 }\nresolution = 100\n");
    EXPECT_FLOAT_EQ(live.amplitude, 0.2F);
    EXPECT_FLOAT_EQ(live.frequency, 0.5F);
    EXPECT_FLOAT_EQ(live.phase, 180.0F);
    EXPECT_EQ(live.wavelength, 3.0F);
    EXPECT_FALSE(good("deform = { amplitude = 0.2, frequency = 2 }\n").wavelength);
}

TEST(SceneLive, Mistakes) {
    const std::string wobble = "deform = { amplitude = 40, frequency = 1";
    expectError("", "2:8", "collider.mesh needs collider.deform");
    expectError("file = \"b.relief\"\n" + wobble + " }\n", "2:8", "exclude each other");
    expectError("deform = 3\n", "3:10", "collider.deform");
    expectError("deform = { kind = \"twist\", amplitude = 40, frequency = 1 }\n", "3:12", "kind");
    expectError("deform = { frequency = 1 }\n", "3:10", "amplitude is missing");
    expectError("deform = { amplitude = 40 }\n", "3:10", "frequency is missing");
    expectError("deform = { amplitude = 40, frequency = -1 }\n", "3:40", "frequency");
    expectError("deform = { amplitude = 1, frequency = 1, wavelength = 0 }\n", "3:55", "wavelength");
    expectError(wobble + ", sped = 1 }\n", "3:43", "sped");
    expectError(wobble + " }\nresolution = 8\n", "4:14", "16");
    expectError(wobble + " }\n[render]\nmesh = \"b.obj\"\n", "5:8", "name collider.mesh");
    expectSceneError("[collider]\nmesh = \"../a.obj\"\n" + wobble + " }\n",
                     "dir/scene.toml:2:8: ", "collider.mesh");
    expectSceneError("[collider]\nfile = \"a.relief\"\n" + wobble + " }\n",
                     "dir/scene.toml:3:10: ", "without collider.mesh");
    expectSceneError("[collider]\nfile = \"a.relief\"\nresolution = 64\n",
                     "dir/scene.toml:3:14: ", "without collider.mesh");
}

TEST(SceneLive, TheMeshIsReadAndItsMapsHoldTheMotion) {
    const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "relief_scene_live_test";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "bar.obj") << "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 0 1 0\nv 2 0.5 1\n"
                                         "f 1 3 2\nf 1 4 3\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";
    SceneCollider collider;
    collider.path = folder / "bar.obj";
    collider.origin = "scene.toml:2:8";
    collider.live.emplace();
    collider.live->amplitude = 0.25F;
    collider.live->phase = 180.0F;
    const auto live = loadLiveMesh(collider);
    ASSERT_TRUE(live) << live.error().message;
    EXPECT_EQ(live->mesh.positions.size(), 5U) << "no vertex is doubled";
    EXPECT_EQ(live->mesh.normals.size(), 5U);
    EXPECT_FLOAT_EQ(live->wobble.phase, std::numbers::pi_v<float>);
    EXPECT_EQ(live->wobble.wavelength, 2.0F) << "half of the longest side";
    ASSERT_EQ(live->frames.maps.size(), 3U);
    EXPECT_LE(live->frames.bounds.min.z, -0.25F);
    EXPECT_GE(live->frames.bounds.max.x, 4.25F);
    EXPECT_LE(live->frames.bounds.max.x, 4.5F);

    collider.path = folder / "none.obj";
    const auto missing = loadLiveMesh(collider);
    ASSERT_FALSE(missing);
    EXPECT_TRUE(missing.error().message.starts_with("scene.toml:2:8: collider.mesh: "))
        << missing.error().message;
    std::ofstream(folder / "point.obj") << "v 1 1 1\nf 1 1 1\n";
    collider.path = folder / "point.obj";
    const auto point = loadLiveMesh(collider);
    ASSERT_FALSE(point);
    EXPECT_EQ(point.error().code, ErrorCode::kInvalidInput);
    std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace relief
