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

TEST(SceneLive, Bend) {
    const SceneLive live = good(
        "deform = { kind = \"bend\", amplitude = 90, frequency = 0.5, phase = 180, axis = [0, 0, -2], "
        "along = [3, 0, 0.1], center = [1, 2, 3], range = [-1, 4] }\nresolution = 100\n");
    const Deformation d = deformationOf(live);
    EXPECT_EQ(d.kind, DeformKind::kBend);
    EXPECT_FLOAT_EQ(d.amplitude, 0.5F * std::numbers::pi_v<float>);
    EXPECT_FLOAT_EQ(d.frequency, 0.5F);
    EXPECT_FLOAT_EQ(d.phase, std::numbers::pi_v<float>);
    EXPECT_EQ(d.axis, glm::vec3(0.0F, 0.0F, -1.0F));
    EXPECT_EQ(d.along, glm::vec3(1.0F, 0.0F, 0.0F));
    EXPECT_EQ(d.center, glm::vec3(1.0F, 2.0F, 3.0F));
    EXPECT_EQ(d.range_low, -1.0F);
    EXPECT_EQ(d.range_high, 4.0F);
    EXPECT_TRUE(live.has_center && live.has_range);
    EXPECT_TRUE(checkDeformation(d));
}

TEST(SceneLive, Defaults) {
    const SceneLive live = good("deform = { kind = \"wobble\", amplitude = 0.2, frequency = 2 }\n");
    EXPECT_EQ(live.deformation.kind, DeformKind::kWobble);
    EXPECT_FALSE(live.has_wavelength);
    EXPECT_TRUE(
        deformationOf(good("deform = { kind = \"twist\", amplitude = 360, frequency = 0 }\n")).amplitude >
        6.0F);
}

TEST(SceneLive, Mistakes) {
    const std::string twist = "deform = { kind = \"twist\", amplitude = 40, frequency = 1";
    expectError("", "2:8", "collider.mesh needs collider.deform");
    expectError("file = \"b.relief\"\n" + twist + " }\n", "2:8", "exclude each other");
    expectError("deform = 3\n", "3:10", "collider.deform");
    expectError("deform = { amplitude = 40, frequency = 1 }\n", "3:10", "kind is missing");
    expectError("deform = { kind = \"melt\", amplitude = 40, frequency = 1 }\n", "3:19", "melt");
    expectError("deform = { kind = \"twist\", frequency = 1 }\n", "3:10", "amplitude is missing");
    expectError("deform = { kind = \"twist\", amplitude = 40 }\n", "3:10", "frequency is missing");
    expectError("deform = { kind = \"twist\", amplitude = 400, frequency = 1 }\n", "3:40", "amplitude");
    expectError("deform = { kind = \"twist\", amplitude = 40, frequency = -1 }\n", "3:56", "frequency");
    expectError(twist + ", axis = [0, 0, 0] }\n", "3:66", "no direction");
    expectError(twist + ", along = [1, 0, 0] }\n", "3:67",
                "does nothing for collider.deform.kind = \"twist\"");
    expectError(twist + ", range = [1, 1] }\n", "3:67", "does not rise");
    expectError(twist + ", range = [1] }\n", "3:67", "[low, high]");
    expectError(twist + ", sped = 1 }\n", "3:59", "sped");
    expectError(twist + " }\nresolution = 8\n", "4:14", "16");
    expectError("deform = { kind = \"bend\", amplitude = 40, frequency = 1 }\n", "3:19", "along");
    expectError("deform = { kind = \"bend\", amplitude = 40, frequency = 1, along = [0, 1, 0] }\n", "3:66",
                "along collider.deform.axis");
    expectError("deform = { kind = \"wobble\", amplitude = 1, frequency = 1, axis = [0, 1, 0] }\n", "3:66",
                "does nothing for collider.deform.kind = \"wobble\"");
    expectError("deform = { kind = \"wobble\", amplitude = 1, frequency = 1, wavelength = 0 }\n", "3:72",
                "wavelength");
    expectError(twist + " }\n[render]\nmesh = \"b.obj\"\n", "5:8", "name collider.mesh");
    expectSceneError("[collider]\nmesh = \"../a.obj\"\n" + twist + " }\n",
                     "dir/scene.toml:2:8: ", "collider.mesh");
    expectSceneError("[collider]\nfile = \"a.relief\"\n" + twist + " }\n",
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
    collider.live->deformation.kind = DeformKind::kTwist;
    collider.live->deformation.axis = glm::vec3(1.0F, 0.0F, 0.0F);
    collider.live->deformation.amplitude = 180.0F;
    const auto live = loadLiveMesh(collider);
    ASSERT_TRUE(live) << live.error().message;
    EXPECT_EQ(live->mesh.positions.size(), 5U) << "no vertex is doubled";
    EXPECT_EQ(live->mesh.normals.size(), 5U);
    EXPECT_EQ(live->deformation.center, glm::vec3(2.0F, 0.5F, 0.5F));
    EXPECT_EQ(live->deformation.range_low, -2.0F);
    EXPECT_EQ(live->deformation.range_high, 2.0F);
    ASSERT_EQ(live->frames.maps.size(), 3U);
    // The far end, 0.7 from the axis, turns all the way round.
    EXPECT_LE(live->frames.bounds.min.z, 0.5F - 0.7F);
    EXPECT_GE(live->frames.bounds.max.z, 0.5F + 0.7F);
    EXPECT_LE(live->frames.bounds.max.z, 0.5F + 0.85F);

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
