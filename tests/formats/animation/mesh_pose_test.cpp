// SPDX-License-Identifier: Apache-2.0
#include "formats/animation/mesh_pose.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <string>

#include "formats/animation/mesh_parts.h"
#include "tests/formats/animation/animated_meshes.h"
#include "tests/results.h"

namespace relief {
namespace {

void expectNear(const glm::vec3& value, const glm::vec3& expected, float tolerance = 1e-5F) {
    EXPECT_LE(glm::length(value - expected), tolerance)
        << value.x << " " << value.y << " " << value.z << ", not " << expected.x << " " << expected.y << " "
        << expected.z;
}

/// The top of the tube, its last vertex, at this time.
glm::vec3 topAt(const AnimatedMesh& mesh, const char* clip, double seconds) {
    return posed(mesh, poseAt(mesh, mesh.clips.at(*findClip(mesh, clip)), seconds)).back();
}

TEST(MeshPose, RotatesAboutTheJointAtConstantSpeed) {
    const AnimatedMesh mesh = bendingTube();
    ASSERT_TRUE(validate(mesh));
    for (const double t : {0.0, 0.1, 0.5, 1.0, 1.25, 2.0}) {
        const double angle = (t <= 1.0 ? t : 2.0 - t) * std::acos(0.0);
        expectNear(topAt(mesh, "bend", t), {-std::sin(angle), 1.0 + std::cos(angle), 0.0});
    }
    expectNear(topAt(mesh, "bend", -5.0), {0, 2, 0});
    expectNear(topAt(mesh, "bend", 7.0), {0, 2, 0});
}

TEST(MeshPose, MorphsBeforeJointsMove) {
    const AnimatedMesh mesh = bendingTube();
    expectNear(posed(mesh, restPose(mesh)).front(), {0.1F, 0, 0});
    for (const float t : {0.0F, 0.25F, 1.0F}) {
        expectNear(posed(mesh, poseAt(mesh, mesh.clips[1], double{t})).front(), {0.1F * (1.0F + t), 0, 0});
    }
}

TEST(MeshPose, TakesTheShorterArcAndEvaluatesSplines) {
    AnimatedMesh mesh = bendingTube();
    MeshClip& clip = mesh.clips[0];
    const float half = std::sqrt(0.5F);
    // The same rotation as the opposite quaternion.
    clip.channels[0].values = {0, 0, 0, 1, 0, 0, -half, -half, 0, 0, 0, 1};
    expectNear(topAt(mesh, "bend", 0.5), {-half, 1.0F + half, 0});
    clip.channels[0].curve = KeyCurve::kStep;
    expectNear(topAt(mesh, "bend", 0.99), {0, 2, 0});
    expectNear(topAt(mesh, "bend", 1.0), {-1, 1, 0});
    // A Hermite curve reproduces the parabola y = 1 + t², with slopes 0 and 2, in one key of 1 s.
    clip.channels[0] = {1,
                        NodeMember::kTranslation,
                        KeyCurve::kCubic,
                        {0.0F, 1.0F},
                        {9, 9, 9, 0, 1, 0, 0, 0, 0, 0, 2, 0, 0, 2, 0, 9, 9, 9}};
    ASSERT_TRUE(validate(mesh));
    for (const double t : {0.0, 0.3, 0.5, 0.9}) {
        expectNear(topAt(mesh, "bend", t), {0, 2.0 + t * t, 0});
    }
}

TEST(MeshPose, FollowsParentsAndMatrices) {
    AnimatedMesh mesh = bendingTube();
    mesh.nodes[0].matrix =
        Affine{{{0, -2, 0, 1}, {2, 0, 0, 0}, {0, 0, 2, 5}}};  // scaled by 2, rotated, moved
    ASSERT_TRUE(validate(mesh));
    expectNear(topAt(mesh, "bend", 1.0), {1.0F - 2.0F * 1.0F, 2.0F * -1.0F, 5.0F});
}

TEST(MeshPose, RepeatsClips) {
    const AnimatedMesh mesh = bendingTube();
    const MeshClip& clip = mesh.clips[0];
    EXPECT_EQ(repeated(clip, 0.5), 0.5);
    EXPECT_EQ(repeated(clip, 2.0), 0.0);
    EXPECT_EQ(repeated(clip, 5.25), 1.25);
    EXPECT_EQ(repeated(clip, -0.25), 1.75);
    EXPECT_EQ(repeated(clip, -1e-300), 0.0);
}

TEST(MeshPose, BoundsContainEveryVertexAtEveryTime) {
    const AnimatedMesh mesh = bendingTube();
    const PoseBounds bounds(mesh);
    const PoseExtent extent = poseExtent(mesh);
    for (const MeshClip& clip : mesh.clips) {
        for (double t = 0.0; t < double{clip.seconds}; t += 0.013) {
            const MeshPose pose = poseAt(mesh, clip, t);
            const Bounds box = bounds.of(pose);
            Bounds exact;
            for (const glm::vec3& p : posed(mesh, pose)) {
                exact.add(p);
            }
            EXPECT_TRUE(glm::all(glm::lessThanEqual(box.min, exact.min + 1e-6F))) << t;
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(box.max, exact.max - 1e-6F))) << t;
            EXPECT_TRUE(glm::all(glm::lessThanEqual(box.size(), extent.box_size))) << t;
            EXPECT_LE(box.longestSide(), 1.4F * exact.longestSide()) << t;
        }
    }
}

// A square that rotates ten times a second, with keys at the times when it is axis-aligned: its box is largest between
// keys.
TEST(MeshPose, RoomContainsFastRotations) {
    AnimatedMesh mesh = movingBox({1.0F, 0.1F, 1.0F});
    ClipChannel& channel = mesh.clips[1].channels[0];
    channel.times.clear();
    channel.values.clear();
    for (int quarter = 0; quarter <= 40; ++quarter) {
        const float angle = 0.25F * 3.14159265F * static_cast<float>(quarter);
        channel.times.push_back(0.025F * static_cast<float>(quarter));
        channel.values.insert(channel.values.end(), {0.0F, std::sin(angle), 0.0F, std::cos(angle)});
    }
    mesh.clips[1].seconds = 1.0F;
    ASSERT_TRUE(validate(mesh)) << validate(mesh).error().message;
    EXPECT_GE(poseExtent(mesh).box_size.x, 2.0F * std::sqrt(2.0F));
    EXPECT_LE(poseExtent(mesh).box_size.x, 2.0F * std::sqrt(2.0F) * 1.021F);
    EXPECT_TRUE(isCyclic(mesh, mesh.clips[1]));
    EXPECT_FALSE(isCyclic(mesh, mesh.clips[0]));
}

TEST(MeshPose, LongIdleClipsAreFast) {
    AnimatedMesh mesh = bendingTube(8, 6);
    mesh.nodes.resize(kMeshNodesMax, mesh.nodes[0]);
    mesh.clips[0].seconds = kClipSecondsMax;
    mesh.clips[0].channels[0].times = {0.0F, 1.0F, kClipSecondsMax};
    ASSERT_TRUE(validate(mesh)) << validate(mesh).error().message;
    EXPECT_GT(poseExtent(mesh).box_size.x, 1.0F);
}

/// Assigns the second of two materials to every third triangle.
void assignMaterials(AnimatedMesh& mesh) {
    mesh.materials = {"cloth", ""};
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        mesh.triangle_materials.push_back(i % 3 == 0 ? 1 : 0);
    }
}

TEST(AnimatedMesh, RoundTrips) {
    AnimatedMesh mesh = bendingTube(8, 6);
    mesh.nodes[0].matrix = Affine{{{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 5}}};
    for (const bool dressed : {false, true}) {
        if (dressed) {
            assignMaterials(mesh);
        }
        const std::vector<std::byte> bytes = writeAnimatedMesh(mesh);
        const AnimatedMesh read = required(readAnimatedMesh(bytes));
        EXPECT_EQ(read, mesh);
        EXPECT_EQ(writeAnimatedMesh(read), bytes);
    }
}

TEST(AnimatedMesh, RejectsTruncationsAndSurvivesFlippedBytes) {
    AnimatedMesh tube = bendingTube(6, 4);
    assignMaterials(tube);
    const std::vector<std::byte> bytes = writeAnimatedMesh(tube);
    for (std::size_t size = 0; size < bytes.size(); size += 7) {
        EXPECT_FALSE(readAnimatedMesh(std::span(bytes).first(size))) << size;
    }
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        std::vector<std::byte> flipped = bytes;
        flipped[i] ^= std::byte{0x81};
        if (const Result<AnimatedMesh> read = readAnimatedMesh(flipped)) {
            ASSERT_TRUE(validate(*read));
            for (const MeshClip& clip : read->clips) {
                EXPECT_EQ(posed(*read, poseAt(*read, clip, 0.5)).size(), read->positions.size());
            }
        }
    }
}

TEST(AnimatedMesh, ErrorsNameTheFault) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    using Change = std::function<void(AnimatedMesh&)>;
    const std::pair<Change, const char*> cases[] = {
        {[](auto& m) { m.positions[3].y = kNan; }, "positions[3] is not finite"},
        {[](auto& m) { m.triangles[2].z = 100'000; }, "triangles[2]"},
        {[](auto& m) { m.influences[0].weight = 0.25F; }, "positions[0] has weights"},
        {[](auto& m) { m.influences[0].weight = kNan; }, "influences[0]"},
        {[](auto& m) { m.influences[5].joint = 2; }, "influences[5]"},
        {[](auto& m) { m.influence_begin[1] = 0; }, "positions[0] has no joints"},
        {[](auto& m) { m.influence_begin[1] = 5000; }, "influence_begin"},
        {[](auto& m) { m.deltas[1].target = 1; }, "deltas[1]"},
        {[](auto& m) { m.delta_begin.pop_back(); }, "delta_begin"},
        {[](auto& m) { m.nodes[1].parent = 1; }, "nodes[1] has a parent"},
        {[](auto& m) { m.nodes[1].rotation = glm::vec4(0.0F); }, "nodes[1] has a transform"},
        {[](auto& m) { m.nodes[0].weights = 2; }, "nodes[0]"},
        {[](auto& m) { m.joints[0].node = 2; }, "joints[0]"},
        {[](auto& m) { m.clips[1].name = "bend"; }, "clips[1] has a name"},
        {[](auto& m) { m.clips[0].seconds = 0.0F; }, "clips[0] has a duration"},
        {[](auto& m) { m.clips[0].seconds = kNan; }, "clips[0] has a duration"},
        {[](auto& m) { m.clips[0].channels[0].times[1] = 0.0F; }, "has times that do not ascend"},
        {[](auto& m) { m.clips[0].channels[0].values.pop_back(); }, "values that do not match its times"},
        {[](auto& m) { m.clips[0].channels[0].values[4] = kNan; }, "keys that are not finite"},
        {[](auto& m) { m.clips[0].channels[0].node = 9; }, "unknown node"},
        {[](auto& m) { m.clips[1].channels[0].node = 1; }, "a member that the node does not have"},
        {[](auto& m) { m.clips[0].channels.push_back(m.clips[0].channels[0]); }, "as another channel"},
        {[](auto& m) { m.materials[1] = "cloth"; }, "materials[1]"},
        {[](auto& m) { m.materials.resize(kMeshMaterialsMax + 1); }, "more nodes, clips or keys"},
        {[](auto& m) { m.materials.pop_back(); }, "triangle_materials[0]"},
        {[](auto& m) { m.triangle_materials.pop_back(); }, "triangle_materials does not have"},
        {[](auto& m) { m.joints.resize(kMeshJointsMax + 1); }, "joints has 4097 entries"},
    };
    for (const auto& [change, words] : cases) {
        AnimatedMesh mesh = bendingTube(8, 6);
        assignMaterials(mesh);
        change(mesh);
        const Result<AnimatedMesh> read = readAnimatedMesh(writeAnimatedMesh(mesh));
        ASSERT_FALSE(read) << words;
        EXPECT_NE(read.error().message.find(words), std::string::npos) << read.error().message;
    }
}

TEST(MeshParts, GroupsAndMaterialsByName) {
    AnimatedMesh mesh = bendingTube(8, 6);
    assignMaterials(mesh);
    EXPECT_EQ(groupNames(mesh), (std::vector<std::string>{"foot", "middle"}));
    const auto foot = groupWeights(mesh, "foot");
    const auto middle = groupWeights(mesh, "middle");
    ASSERT_TRUE(foot && middle);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        EXPECT_NEAR((*foot)[i] + (*middle)[i], 1.0F, 1e-6F);
        const float y = mesh.positions[i].y;
        EXPECT_NEAR((*middle)[i], std::clamp(1.5F * y - 1.0F, 0.0F, 1.0F), 1e-6F);
    }
    // Joints with the same name form one group. A joint without vertices forms none.
    mesh.nodes[1].name = "foot";
    EXPECT_EQ(groupWeights(mesh, "foot").value_or(std::vector<float>()),
              std::vector<float>(mesh.positions.size(), 1.0F));
    mesh.joints.push_back(mesh.joints[1]);
    mesh.joints.back().node = 0;
    mesh.nodes[0].name = "unused";
    EXPECT_EQ(groupNames(mesh), (std::vector<std::string>{"unused", "foot"}));

    EXPECT_EQ(materialTriangles(mesh, "cloth")->size(), mesh.triangles.size() * 2 / 3);
    EXPECT_FALSE(materialTriangles(mesh, "")) << "no name";
    const auto none = materialTriangles(mesh, "Cl\noth");
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message.find('\n'), std::string::npos);
    EXPECT_NE(none.error().message.find("the mesh has 'cloth'"), std::string::npos) << none.error().message;
    // Long lists are truncated.
    std::vector<std::string> many;
    for (int i = 0; i < 30; ++i) {
        many.push_back("name " + std::to_string(i));
    }
    const std::string listed = partNotFound("group", "x", many);
    EXPECT_NE(listed.find("'name 19', …"), std::string::npos) << listed;
    EXPECT_EQ(listed.find("name 20"), std::string::npos) << listed;
}

}  // namespace
}  // namespace relief
