// SPDX-License-Identifier: Apache-2.0
// Animated glTF files: poses compared with closed forms, and rejected files.
#include "bake/import/animated_import.h"

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <limits>
#include <numeric>

#include "bake/import/import_source.h"
#include "bake/import/mesh_import.h"
#include "formats/animation/mesh_pose.h"
#include "formats/base/file_io.h"
#include "tests/bake/import/animated_cases.h"
#include "tests/bake/import/import_meshes.h"
#include "tests/bake/meshes.h"
#include "tests/seeds.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const float kNan = std::numeric_limits<float>::quiet_NaN();

Result<AnimatedImport> load(const GltfBuilder& builder, const ImportOptions& options = {}) {
    const TemporaryFolder folder;
    return importAnimatedInWorker(writeGltf(builder.file(), folder, "a"), {}, options);
}

AnimatedImport loaded(const GltfBuilder& builder, const ImportOptions& options = {}) {
    return required(load(builder, options));
}

std::vector<glm::vec3> at(const AnimatedMesh& mesh, const std::string& clip, double seconds) {
    const std::optional<std::size_t> index = findClip(mesh, clip);
    EXPECT_TRUE(index) << clip;
    return posed(mesh, index ? poseAt(mesh, mesh.clips[*index], seconds) : restPose(mesh));
}

void expectNear(const glm::vec3& a, const glm::dvec3& b, double tolerance) {
    EXPECT_LE(glm::distance(glm::dvec3(a), b), tolerance)
        << a.x << " " << a.y << " " << a.z << " instead of " << b.x << " " << b.y << " " << b.z;
}

/// Six times the enclosed volume; negative if triangles face inwards.
double volumeOf(const AnimatedMesh& mesh, const std::vector<glm::vec3>& positions, std::size_t first,
                std::size_t count) {
    double sum = 0.0;
    for (std::size_t i = first; i < first + count; ++i) {
        const glm::uvec3& t = mesh.triangles[i];
        sum += glm::dot(glm::dvec3(positions[t.x]),
                        glm::cross(glm::dvec3(positions[t.y]), glm::dvec3(positions[t.z])));
    }
    return sum;
}

using Change = std::function<void(GltfBuilder&)>;

/// Sets a JSON value. \param at  a JSON pointer
Change set(const std::string& at, const Json& value) {
    return [=](GltfBuilder& builder) { builder.json[Json::json_pointer(at)] = value; };
}
Change erased(const std::string& at, const char* name) {
    return [=](GltfBuilder& builder) { builder.json[Json::json_pointer(at)].erase(name); };
}
/// Sets the index of a new accessor.
Change floats(const std::string& at, const char* type, const std::vector<float>& values) {
    return [=](GltfBuilder& builder) { builder.json[Json::json_pointer(at)] = builder.floats(type, values); };
}
Change appended(const std::string& at, const Json& value) {
    return [=](GltfBuilder& builder) { builder.json[Json::json_pointer(at)].push_back(value); };
}

const std::string kPrimitive = "/meshes/0/primitives/0";
const std::string kWeights = kPrimitive + "/attributes/WEIGHTS_0";
const std::string kTarget = kPrimitive + "/targets/0/POSITION";
const std::string kBinds = "/skins/0/inverseBindMatrices";
const std::string kAnimation = "/animations/0";
const std::string kInput = kAnimation + "/samplers/0/input";
const std::string kOutput = kAnimation + "/samplers/0/output";
const std::string kInstances = "/nodes/2/extensions/EXT_mesh_gpu_instancing/attributes/TRANSLATION";

TEST(AnimatedImport, KeepsAnimatedParts) {
    const AnimatedMesh bar = loaded(bendingBar()).mesh;
    ASSERT_EQ(bar.positions.size(), 12U);
    EXPECT_EQ(bar.joints.size(), 2U);
    EXPECT_EQ(bar.influences.size(), 4U + 8U + 4U) << "weights of 0 are dropped";
    EXPECT_GT(volumeOf(bar, posed(bar, restPose(bar)), 0, bar.triangles.size()), 0.0);
    // The upper half makes a quarter turn, quantized to 16 bits.
    const std::vector<glm::vec3> bent = at(bar, "bend", 2.0);
    for (std::size_t i = 0; i < bent.size(); ++i) {
        const glm::dvec3 p(bar.positions[i]);
        const glm::dvec3 turned(1.0 - p.y, 1.0 + p.x, p.z);
        expectNear(bent[i], i < 4 ? p : i < 8 ? 0.5 * (p + turned) : turned, 1e-4);
    }
    const AnimatedImport import = loaded(robot());
    const AnimatedMesh& mesh = import.mesh;
    ASSERT_EQ(mesh.positions.size(), 24U);
    // base, arm, hand: parents precede children, below the frame
    ASSERT_EQ(mesh.nodes.size(), 4U);
    EXPECT_EQ(mesh.nodes[1].name, "base");
    EXPECT_EQ(mesh.nodes[2].parent, 1);
    const std::vector<glm::vec3> rest = posed(mesh, restPose(mesh));
    for (std::size_t part = 0; part < 3; ++part) {
        EXPECT_NEAR(volumeOf(mesh, rest, 12 * part, 12), 36.0, 1e-4)
            << "including the mirrored hand; part " << part;
    }
    EXPECT_EQ(mesh.clips[0].seconds, 3.5F);
    EXPECT_EQ(import.rest.positions.size(), 24U);
    EXPECT_EQ(import.rest.bounds.max, glm::vec3(2, 6, 3));
    const AnimatedMesh cube = loaded(morphingCube()).mesh;
    ASSERT_EQ(cube.weights, (std::vector<float>{0.5F, 0.0F}))
        << "weights of the node override those of the mesh";
    EXPECT_EQ(cube.deltas.size(), 4U) << "zero deltas are dropped";
}

// Materials with equal names are one material. A missing name is "". Nothing is kept if no material has a name.
TEST(AnimatedImport, KeepsMaterialNames) {
    GltfBuilder builder = robot();
    EXPECT_TRUE(loaded(builder).mesh.materials.empty());
    Json& primitives = builder.json["meshes"][0]["primitives"];
    for (int i = 1; i < 4; ++i) {
        primitives.push_back(primitives[0]);
    }
    builder.json["materials"] = Json::array({{{"name", "steel"}}, Json::object(), {{"name", "steel"}}});
    primitives[1]["material"] = 0;
    primitives[2]["material"] = 1;
    primitives[3]["material"] = 2;
    const AnimatedMesh mesh = loaded(builder).mesh;
    EXPECT_EQ(mesh.materials, (std::vector<std::string>{"", "steel"}));
    ASSERT_EQ(mesh.triangle_materials.size(), 3U * 4U * 12U);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        EXPECT_EQ(mesh.triangle_materials[i], i / 12 % 2) << i;
    }
    builder.json["materials"] = Json::array({Json::object(), Json::object(), Json::object()});
    EXPECT_TRUE(loaded(builder).mesh.materials.empty());
    primitives[3]["material"] = 3;
    EXPECT_FALSE(load(builder)) << "no such material";
}

TEST(AnimatedImport, UnitAndAxisApplyAboveTheRoot) {
    const AnimatedImport import = loaded(bendingBar(), {"cm", UpAxis::kPlusZ});
    const std::vector<glm::vec3> plain = at(loaded(bendingBar()).mesh, "bend", 0.7);
    const std::vector<glm::vec3> turned = at(import.mesh, "bend", 0.7);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        expectNear(turned[i], 0.01 * glm::dvec3(plain[i].x, plain[i].z, -plain[i].y), 1e-7);
    }
    EXPECT_EQ(import.rest.unit, "m");
}

TEST(AnimatedImport, NodeMatricesMustNotShear) {
    GltfBuilder builder = robot();
    builder.json["nodes"][2].erase("translation");
    builder.json["nodes"][2]["matrix"] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
    const AnimatedMesh mesh = loaded(builder).mesh;
    EXPECT_FALSE(mesh.nodes[1].matrix);
    expectNear(posed(mesh, restPose(mesh))[7], {5 - 6, 2, 3}, 1e-5);
    expectNear(at(mesh, "drive", 1.5)[7], {4 - 6, 2, 3}, 1e-5);
    builder.json["nodes"][2]["matrix"] = {1, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1};
    expectRejected(load(builder), "nodes[2], whose matrix is not a translation");
}

TEST(AnimatedImport, InstancesAndJointsOutsideTheSceneAreAnimated) {
    GltfBuilder builder = robot();
    floats(kInstances, "VEC3", {0, 0, 0, 0, 0, 10})(builder);
    const AnimatedMesh instances = loaded(builder).mesh;
    ASSERT_EQ(instances.positions.size(), 32U);
    expectNear(at(instances, "drive", 1.5)[8], {4, 0, 10}, 1e-6);
    GltfBuilder bar = bendingBar();
    bar.json["scenes"][0]["nodes"] = {0};
    EXPECT_EQ(loaded(bar).mesh.joints.size(), 2U);
    bar.json["skins"][0].erase("inverseBindMatrices");
    const AnimatedMesh unbound = loaded(bar).mesh;
    EXPECT_EQ(unbound.joints[1].bind, Affine{});
    expectNear(posed(unbound, restPose(unbound))[8], {-0.5, 3, -0.5}, 1e-6);
}

TEST(AnimatedImport, ChannelsMatchTheirClosedForms) {
    GltfBuilder swings = robot();
    const std::size_t times = swings.floats("SCALAR", {0.25F, 1, 3});
    const auto half = static_cast<float>(std::sqrt(0.5));
    // A quarter turn, then back. Tangents are 0.
    swings.animate(1, "rotation", times,
                   swings.floats("VEC4", {0,    0,    0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,
                                          half, half, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0}),
                   "CUBICSPLINE", "spin");
    swings.animate(2, "translation", times, swings.floats("VEC3", {9, 9, 9, 0, 0, 0, 1, 0, 0, 0, 2, 0, 4, 0,
                                                                   0, 0, 1, 0, 0, 0, 1, 2, 2, 2, 3, 0, 3}),
                   "CUBICSPLINE", "swing");
    swings.animate(0, "scale", times, swings.floats("VEC3", {1, 1, 1, 2, 1, 0.5F, 1, 3, 1}), "LINEAR",
                   "grow");
    const AnimatedMesh mesh = loaded(swings).mesh;
    ASSERT_EQ(mesh.clips.size(), 5U);
    for (const std::size_t clip : {2U, 3U, 4U}) {
        EXPECT_EQ(mesh.clips[clip].seconds, 3.0F);
    }
    // Corner 7 of a box is (1, 2, 3). The arm's node is at (1, 2, 0), and the hand's is another (0, 2, 0) above it.
    expectNear(at(mesh, "turn", 1.4)[15], {2, 4, 3}, 1e-4);
    expectNear(at(mesh, "turn", 2.0)[15], {-1, 3, 3}, 1e-4);
    // Between two keys: an eighth turn, and Hermite's polynomial at ½ of 0.75 s.
    const double eighth = std::sqrt(0.5);
    expectNear(at(mesh, "spin", 0.625)[15], {1 + eighth * (1 - 2), 2 + eighth * (1 + 2), 3}, 1e-4);
    expectNear(at(mesh, "swing", 0.625)[0], {2.0 + 0.75 * 0.125, -0.75 * 0.125 * 2.0, 0.0}, 1e-5);
    expectNear(at(mesh, "grow", 0.625)[23], {1 + 1.5, 2 + 2 + 2, 2.25}, 1e-5);
    const AnimatedMesh cube = loaded(morphingCube()).mesh;
    expectNear(at(cube, "stretch", 1.0)[7], {1.0 + 0.5 * 2.0, 1, 1}, 1e-4);
    expectNear(at(cube, "stretch", 0.5)[7], {1.0 + 0.25 * 2.0, 1, 1}, 1e-4);
}

// --- names, and clips of other files ---

TEST(AnimatedImport, ClipsOfOtherFilesAnimateNodesByName) {
    const TemporaryFolder folder;
    GltfBuilder still = robot();
    still.json.erase("animations");
    GltfBuilder moves = robot();
    moves.json.erase("meshes");
    // Different node indices, a different hierarchy, and one more node.
    moves.json["nodes"] = {{{"name", "elsewhere"}}, {{"name", "base"}}, {{"name", "arm"}}};
    moves.json["scenes"][0]["nodes"] = {0, 1, 2};
    moves.json["animations"][0]["channels"][0]["target"]["node"] = 1;
    moves.json["animations"][1]["channels"][0]["target"]["node"] = 2;
    Json lost = moves.json["animations"][0]["channels"][0];
    lost["target"]["node"] = 0;
    moves.json["animations"][0]["channels"].push_back(lost);
    const fs::path file = writeGltf(still.file(), folder, "still");
    const fs::path clips = writeGltf(moves.file(), folder, "moves");
    const AnimatedImport merged = required(importAnimatedInWorker(file, {clips, clips}));
    const AnimatedMesh& mesh = merged.mesh;
    ASSERT_EQ(mesh.clips.size(), 4U);
    EXPECT_EQ(mesh.clips[2].name, "drive 2");
    EXPECT_TRUE(warns(merged.rest, "moves.glb: another clip has the name 'drive'"));
    EXPECT_TRUE(
        warns(merged.rest, "moves.glb: left out channels of nodes that the mesh does not have: 'elsewhere'"));
    const AnimatedMesh own = loaded(robot()).mesh;
    EXPECT_EQ(at(mesh, "drive", 1.2), at(own, "drive", 1.2));
    EXPECT_EQ(at(mesh, "turn 2", 2.0), at(own, "turn", 2.0));
    EXPECT_EQ(merged.rest.dependencies.size(), 3U);

    moves.json["nodes"] = {{{"name", "elsewhere"}}, {{"name", "BASE"}}, Json::object()};
    const fs::path strange = writeGltf(moves.file(), folder, "strange");
    expectRejected(importAnimatedInWorker(file, {strange}),
                   "strange.glb': none of its animated nodes has the name of a node of the mesh");
    EXPECT_FALSE(importAnimatedInWorker(file, {file})) << "the clip file has no animation";
}

TEST(AnimatedImport, ClipNamesAreUnique) {
    GltfBuilder builder = robot();
    builder.json["animations"][0].erase("name");
    builder.json["animations"][1]["name"] = "clip 0";
    const AnimatedImport import = loaded(builder);
    ASSERT_EQ(import.mesh.clips.size(), 2U);
    EXPECT_EQ(import.mesh.clips[0].name, "clip 0");
    EXPECT_EQ(import.mesh.clips[1].name, "clip 0 2");
    EXPECT_TRUE(warns(import.rest, "another clip has the name 'clip 0'; this one is renamed to 'clip 0 2'"));
}

// --- valid and invalid files ---

TEST(AnimatedImport, EmptyChannelsAreDropped) {
    GltfBuilder builder = robot();
    const std::size_t once = builder.floats("SCALAR", {0});
    builder.animate(2, "translation", once, builder.floats("VEC3", {0, 0, 0}), "LINEAR", "pose");
    builder.json["nodes"].push_back({{"name", "unseen"}});
    builder.animate(3, "translation", 2, 3, "LINEAR", "away");
    builder.json["animations"][0]["channels"].push_back(
        {{"sampler", 0}, {"target", {{"path", "pointer"}, {"extensions", Json::object()}}}});
    const AnimatedImport import = loaded(builder);
    EXPECT_EQ(import.mesh.clips.size(), 2U);
    EXPECT_TRUE(warns(import.rest, "the animation 'pose' has zero length; it is left out"));
    EXPECT_TRUE(warns(import.rest, "the animation 'away' does not move the mesh; it is left out"));
}

TEST(AnimatedImport, WeightsAreNormalized) {
    GltfBuilder builder = bendingBar();
    std::vector<float> weights(48, 0.0F);
    for (std::size_t i = 0; i < weights.size(); i += 4) {
        weights[i] = i == 0 ? 3.0F : 0.99F;
    }
    floats(kWeights, "VEC4", weights)(builder);
    const AnimatedImport import = loaded(builder);
    EXPECT_TRUE(warns(import.rest, "1 vertex has joint weights that do not sum to 1"));
    EXPECT_EQ(import.mesh.influences[0].weight, 1.0F);
}

TEST(AnimatedImport, InvalidFilesAreRejectedInOneLine) {
    struct Case {
        const char* words;
        GltfBuilder (*base)();
        Change change;
        ErrorCode code = ErrorCode::kInvalidInput;
    };
    std::vector<float> binds(32, 0.0F);
    for (const std::size_t i : {0U, 5U, 10U, 15U, 16U, 21U, 26U, 31U}) {
        binds[i] = 1.0F;
    }
    binds[12] = kNan;
    std::vector<float> places(15'000);
    std::iota(places.begin(), places.end(), 0.0F);
    const Json twice = robot().json[Json::json_pointer(kAnimation + "/channels/0")];
    const std::vector<Case> all = {
        {"skins[0] has no joints", bendingBar, set("/skins/0/joints", Json::array())},
        {"skins[0] has fewer inverseBindMatrices than joints", bendingBar, set("/skins/0/joints", {2, 1, 0})},
        {"has vertices with a joint that is missing in its skin, skins[0]", bendingBar,
         set("/skins/0/joints", Json::array({2}))},
        {"have weights that are negative, not numbers, or 0", bendingBar,
         floats(kWeights, "VEC4", std::vector<float>(48, kNan))},
        {"has inverseBindMatrices that are not numbers", bendingBar, floats(kBinds, "MAT4", binds)},
        {"skins[0] has inverseBindMatrices whose last row is not 0 0 0 1", bendingBar,
         floats(kBinds, "MAT4", std::vector<float>(32, 1.0F))},
        {"have only one of JOINTS_0 and WEIGHTS_0", bendingBar,
         erased(kPrimitive + "/attributes", "WEIGHTS_0")},
        {"is not normalized", bendingBar,
         [](GltfBuilder& s) {
             s.json[Json::json_pointer(kWeights)] = s.bytes("VEC4", std::vector<int>(48, 1));
         }},
        {"has the time 0.5 at key 1; key times must not be negative", robot,
         floats(kInput, "SCALAR", {0.5F, 0.5F, 1})},
        {"has the time 0.25 at key 1;", robot, floats(kInput, "SCALAR", {0.5F, 0.25F, 1})},
        {"has the time -1 at key 0;", robot, floats(kInput, "SCALAR", {-1, 0, 1})},
        {"has the time NaN or infinity at key 2;", robot, floats(kInput, "SCALAR", {0, 1, kNan})},
        {"has no keys", robot, floats(kInput, "SCALAR", {})},
        {"has 9 numbers instead of 3 for each of 2 keys", robot, floats(kInput, "SCALAR", {0, 1})},
        {"lasts longer than a day", robot, floats(kInput, "SCALAR", {0, 1, 90'000}), ErrorCode::kLimit},
        {"has key values that are not numbers", robot, floats(kOutput, "VEC3", std::vector<float>(9, kNan))},
        {"has a rotation at key 0 that is not a unit quaternion: its length is 0", robot,
         floats("/animations/1/samplers/0/output", "VEC4", std::vector<float>(12, 0.0F))},
        {"moves the translation of nodes[2], which another channel also moves", robot,
         appended(kAnimation + "/channels", twice)},
        {"nodes[9], which does not exist", robot, set(kAnimation + "/channels/0/target/node", 9)},
        {"samplers[7], which does not exist", robot, set(kAnimation + "/channels/0/sampler", 7)},
        {"accessors[77], which does not exist", robot, set(kOutput, 77)},
        {"has the interpolation 'QUADRATIC'", robot,
         set(kAnimation + "/samplers/0/interpolation", "QUADRATIC")},
        {"has no target, or its target has no path", robot, erased(kAnimation + "/channels/0", "target")},
        {"moves the morph targets of nodes[2], which has none", robot,
         set(kAnimation + "/channels/0/target/path", "weights")},
        {"moves 7 vertices, but the primitive has 8", morphingCube,
         floats(kTarget, "VEC3", std::vector<float>(21, 0.0F))},
        {"extends beyond its buffer view", morphingCube,
         [](GltfBuilder& s) {
             floats(kTarget, "VEC3", std::vector<float>(21, 0.0F))(s);
             s.json["accessors"].back()["count"] = 8;
         }},
        {"moves a vertex by a value that is not a number", morphingCube,
         floats(kTarget, "VEC3", std::vector<float>(24, kNan))},
        {"has 1 morph targets, but an earlier primitive has 2", morphingCube,
         [](GltfBuilder& s) {
             Json other = s.json[Json::json_pointer(kPrimitive)];
             other["targets"].erase(1);
             s.json["meshes"][0]["primitives"].push_back(other);
         }},
        {"has 3 weights for 2 morph targets", morphingCube, set("/nodes/0/weights", {1, 2, 3})},
        {"exceeds the limit of 1024 morph targets", morphingCube,
         set(kPrimitive + "/targets", std::vector<Json>(1025, Json::object())), ErrorCode::kLimit},
        {"but at most 8191 are supported", robot,
         [](GltfBuilder& s) {
             for (int i = 3; i < 8200; ++i) {
                 s.json["nodes"].push_back(Json::object());
                 s.json["scenes"][0]["nodes"].push_back(i);
             }
         },
         ErrorCode::kLimit},
        {"more than 4096 joints, nodes and instances move its vertices", robot,
         floats(kInstances, "VEC3", places), ErrorCode::kLimit},
        {"nothing in it moves: no skin, no morph target and no animation", robot, erased("", "animations")},
        {"nodes must form trees", robot, set("/nodes/0/children", Json::array({2}))},
        {"no triangles, but 36 points", robot, set(kPrimitive + "/mode", 0)},
    };
    for (const Case& wrong : all) {
        SCOPED_TRACE(wrong.words);
        GltfBuilder builder = wrong.base();
        wrong.change(builder);
        const Result<AnimatedImport> import = load(builder);
        expectRejected(import, wrong.words, wrong.code);
        expectRejected(import, "a.glb'", wrong.code);
    }
}

TEST(AnimatedImport, MutatedFilesAreReadOrRejectedInOneLine) {
    const TemporaryFolder folder;
    Dice dice(seedFrom(11));
    int read = 0;
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        GltfCase file = (i % 3 == 0 ? bendingBar() : i % 3 == 1 ? robot() : morphingCube()).file();
        const std::string change = mutateGltf(file.document, dice);
        SCOPED_TRACE(change);
        const std::vector<std::byte> bytes = required(readFile(writeGltf(file, folder, "m")));
        const auto kind = i % 2 == 0 ? ImportKind::kAnimated : ImportKind::kClips;
        ImportJob job{"'m.glb'", "m.glb", "glb", bytes, -1, {}};
        job.kind = kind;
        const Result<TriangleMesh> raw = importRaw(job);
        ++(raw ? read : refused);
        if (raw) {
            EXPECT_TRUE(kind == ImportKind::kClips ? readAnimatedClips(raw->animation)
                                                   : readAnimatedMesh(raw->animation));
        } else {
            expectFault(raw.error(), "", raw.error().code);
        }
    }
    EXPECT_GT(read, 30);
    EXPECT_GT(refused, 30);
}

TEST(AnimatedImport, OnlyGltfIsRead) {
    const TemporaryFolder folder;
    expectRejected(importAnimatedInWorker(folder.write("t.obj", tetrahedronObj()), {}),
                   "animations in .obj files are not supported; convert the file to glTF",
                   ErrorCode::kUnsupported);
}

TEST(AnimatedImport, InvalidWorkerResultsAreRejected) {
    const TemporaryFolder folder;
    const ImportSource source = required(ImportSource::open(folder.write("l.glb", "glTF")));
    const AnimatedMesh mesh = loaded(robot()).mesh;
    TriangleMesh honest;
    honest.animation = writeAnimatedMesh(mesh);
    EXPECT_TRUE(source.finishAnimated(TriangleMesh(honest), ImportKind::kClips)->mesh.positions.empty());
    EXPECT_FALSE(source.finish(honest)) << "an animation that was not requested";
    EXPECT_FALSE(source.finishLevel(honest));
    const auto changed = [&](const std::function<void(AnimatedMesh&)>& change) {
        return [mesh, change](TriangleMesh& raw) {
            AnimatedMesh bad = mesh;
            change(bad);
            raw.animation = writeAnimatedMesh(bad);
        };
    };
    expectInvalidRejected(honest,
                          {
                              [](TriangleMesh& raw) { raw.animation.clear(); },
                              [](TriangleMesh& raw) { raw.animation.resize(100); },
                              [](TriangleMesh& raw) { raw.positions.emplace_back(0.0F); },
                              [](TriangleMesh& raw) { raw.level_meshes.emplace_back(); },
                              [](TriangleMesh& raw) { raw.marks = {1}; },
                              changed([](AnimatedMesh& bad) { bad.triangles[0].x = 999; }),
                              changed([](AnimatedMesh& bad) { bad.nodes[1].translation.x = 1e30F; }),
                          },
                          [&](TriangleMesh raw) {
                              return source.finishAnimated(std::move(raw), ImportKind::kAnimated).has_value();
                          });
}

}  // namespace
}  // namespace relief::test
