// SPDX-License-Identifier: Apache-2.0
// World files from untrusted sources: valid files are read; all others are rejected with the position.
#include "formats/world/world.h"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/world/world_field.h"
#include "tests/formats/analytic_shapes.h"
#include "tests/formats/random_patches.h"
#include "tests/formats/sample_colliders.h"
#include "tests/results.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

World smallWorld() {
    World world;
    world.unit = "m";
    world.colliders.push_back(
        {{"chair.relief", std::string(32, 'a'), 4096}, "chair", {glm::vec3(0.0F), glm::vec3(1.0F)}, {}});
    world.bodies.push_back(
        {0, "chair.001", {1.0F, 0.1F, -3.0F}, {0.0F, 0.6F, 0.0F, 0.8F}, 2.0F, 0.5F, 0.25F});
    world.bodies.push_back({});
    return world;
}

/// The text with one part replaced. The test fails if the part is missing.
std::string with(const std::string& part, const std::string& other) {
    std::string text = worldText(smallWorld());
    const std::size_t at = text.find(part);
    EXPECT_NE(at, std::string::npos) << part;
    return at == std::string::npos ? text : text.replace(at, part.size(), other);
}

TEST(World, RoundTripsWithOneItemPerLine) {
    const std::string text = worldText(smallWorld());
    EXPECT_EQ(text, R"({
  "format": "relief-world",
  "version": 1,
  "unit": "m",
  "colliders": [
    {"file":"chair.relief","hash":"aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa","gpu_bytes":4096,"mesh":"chair","min":[0.0,0.0,0.0],"max":[1.0,1.0,1.0]}
  ],
  "bodies": [
    {"collider":0,"node":"chair.001","position":[1.0,0.1,-3.0],"rotation":[0.0,0.6,0.0,0.8],"scale":2.0,"restitution":0.5,"friction":0.25},
    {"collider":0,"node":"","position":[0.0,0.0,0.0],"rotation":[0.0,0.0,0.0,1.0],"scale":1.0,"restitution":1.0,"friction":0.0}
  ]
}
)");
    const World read = required(parseWorld(text));
    EXPECT_EQ(worldText(read), text);
}

TEST(World, InvalidFilesAreRejectedWithPositionAndFix) {
    struct Case {
        const char* part;
        std::string other;
        const char* message;
    };
    const auto coarse = [](const std::string& file) {
        return R"([1.0,1.0,1.0],"coarse":{"file":")" + file + R"(","hash":")" + std::string(32, 'a') +
               R"(","gpu_bytes":256})";
    };
    for (const Case& one : std::initializer_list<Case>{
             {R"("collider":0,"node":"chair.001")", R"("collider":1,"node":"")", "bodies[0].collider = 1 is"},
             {R"("collider":0,"node":"chair.001")", R"("collider":0.5,"node":"")", "bodies[0].collider must"},
             {"[0.0,0.6,0.0,0.8]", "[0.0,0.6,0.0,0.9]", "bodies[0].rotation is"},
             {"[0.0,0.6,0.0,0.8]", "[0,0,0,0]", "bodies[0].rotation is"},
             {"[0.0,0.6,0.0,0.8]", "[0,0,1]", "bodies[0].rotation must"},
             {"\"scale\":2.0", "\"scale\":0", "bodies[0].scale = 0 is out of range"},
             {"\"scale\":2.0", "\"scale\":1e-300", "bodies[0].scale = "},
             {"\"scale\":2.0", "\"scale\":\"2\"", "bodies[0].scale must be a number"},
             {"\"scale\":2.0", "\"scale\":NaN", "not valid JSON"},
             {"\"scale\":2.0", "\"scale\":2.0,\"scale\":2.0", "has the key 'scale' twice"},
             {"\"scale\":2.0", "\"scales\":2.0", "bodies[0] has no scale"},
             {"\"scale\":2.0", "\"scale\":2.0,\"frction\":0",
              "bodies[0] has an unknown key 'frction'; did you mean 'friction'?"},
             {"\"friction\":0.25", "\"friction\":1.5", "choose 0 to 1"},
             {"[1.0,0.1,-3.0]", "[1e30,0,0]", "bodies[0].position[0] = "},
             {"chair.relief", "../chair.relief", "colliders[0].file = "},
             {"chair.relief", "a/../../chair.relief", "must be a path inside"},
             {"chair.relief", "/chair.relief", "must be a path inside"},
             {"chair.relief", "", "must be a path inside"},
             {"chair.relief", "a\\u0000b", "contains a zero byte"},
             {"aaaa", "AAAA", "colliders[0].hash"},
             {"\"gpu_bytes\":4096", "\"gpu_bytes\":0", "colliders[0].gpu_bytes"},
             {"[1.0,1.0,1.0]", "[1.0,1.0,1.0],\"coarse\":{}", "coarse has no file"},
             {"[1.0,1.0,1.0]", "[1.0,1.0,1.0],\"coarse\":null", "colliders[0].coarse "},
             {"[1.0,1.0,1.0]", coarse("chair.relief"), "is also used by another"},
             {"[1.0,1.0,1.0]", coarse("../c.relief"), "coarse.file = "},
             {"\"min\":[0.0", "\"min\":[2.0", "colliders[0].min is"},
             {"relief-world", "relief-cache", "is not a world"},
             {"\"version\": 1", "\"version\": 2", "newer than this program"},
             {"\"unit\": \"m\"", "\"unit\": \"cm\"", "unit must be"},
             {"\n}\n", ",\"x\":1}", "unknown key 'x'"},
             {"\n}\n", "", "not valid JSON"}}) {
        const Result<World> read = parseWorld(with(one.part, one.other));
        ASSERT_FALSE(read) << one.other;
        EXPECT_NE(read.error().message.find(one.message), std::string::npos) << read.error().message;
        EXPECT_NE(read.error().message.find("; "), std::string::npos) << read.error().message;
        EXPECT_EQ(read.error().message.find('\n'), std::string::npos) << read.error().message;
    }
    EXPECT_EQ(parseWorld(with("\"version\": 1", "\"version\": 2")).error().code, ErrorCode::kUnsupported);
}

TEST(World, HasLimits) {
    World world = smallWorld();
    world.bodies.resize(kWorldBodiesMax);
    std::string text = worldText(world);
    EXPECT_TRUE(parseWorld(text));
    const std::size_t last = text.rfind("    {");
    text.insert(last, text.substr(last, text.find('\n', last) - last) + ",\n");
    EXPECT_FALSE(parseWorld(text)) << "one body too many";
    world = smallWorld();
    for (std::size_t i = 1; i <= kWorldCollidersMax; ++i) {
        world.colliders.push_back(world.colliders[0]);
        world.colliders.back().file = std::to_string(i) + ".relief";
    }
    EXPECT_FALSE(parseWorld(worldText(world)));
    world.colliders.pop_back();
    EXPECT_TRUE(parseWorld(worldText(world)));
    world.colliders.back().file = "./chair.relief";
    EXPECT_FALSE(parseWorld(worldText(world))) << "the same file twice";
    EXPECT_EQ(parseWorld("[" + std::string(8'000'000, '[') + "]").error().code, ErrorCode::kLimit);
    std::string many = "[0";
    for (int i = 0; i < 2'000'000; ++i) {
        many += ",0";
    }
    EXPECT_EQ(parseWorld(many + "]").error().code, ErrorCode::kLimit) << "before memory is allocated";
}

/// A folder that contains a world of one collider.
class WorldFolder : public testing::Test {
  protected:
    void SetUp() override {
        // A sphere of radius ½, with maps along z from both sides.
        collider_.bounds = {glm::vec3(-0.5F), glm::vec3(0.5F)};
        collider_.maps = {test::makeMap(*test::makeSphere({0, 0, 0}, 0.5),
                                        test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {1.01, 1.01, 1.01}),
                                        MapFormat::kFrontBackFixed, Compare::kBoth, 64, 64)};
        writeCollider();
        world_.bodies.resize(1);
    }
    /// Writes the world's only collider.
    void writeCollider() {
        const std::vector<std::byte> bytes = test::written(collider_);
        ASSERT_TRUE(writeFile(folder_ / "a.relief", bytes));
        world_.colliders = {{fileOf("a.relief", bytes), "a", collider_.bounds, {}}};
    }
    [[nodiscard]] WorldFile fileOf(const char* name, std::span<const std::byte> bytes) const {
        return {name, xxh3_128Hex(bytes), collider_.texelBytes()};
    }
    Result<LoadedWorld> load(WorldDetail detail = WorldDetail::kFine) {
        const std::string text = worldText(world_);
        EXPECT_TRUE(writeFile(folder_ / "world.json", std::as_bytes(std::span(text))));
        return loadWorld(folder_ / "world.json", {}, detail);
    }
    void expectRefused(const char* message, ErrorCode code = ErrorCode::kInvalidInput) {
        const Result<LoadedWorld> loaded = load();
        ASSERT_FALSE(loaded);
        EXPECT_EQ(loaded.error().code, code);
        EXPECT_NE(loaded.error().message.find("world.json': colliders[0]"), std::string::npos)
            << loaded.error().message;
        EXPECT_NE(loaded.error().message.find(message), std::string::npos) << loaded.error().message;
    }

    test::TemporaryFolder temporary_;
    fs::path folder_ = temporary_.path();
    Collider collider_;
    World world_;
};

TEST_F(WorldFolder, ContainersExistAndMatchTheirHashes) {
    world_.colliders[0].hash[0] = world_.colliders[0].hash[0] == '0' ? '1' : '0';
    expectRefused("does not match its hash");
    SetUp();
    world_.colliders[0].box.max.x += 1.0F;
    expectRefused("does not match its min and max");
    SetUp();
    world_.colliders[0].gpu_bytes += 8;
    expectRefused("bytes on the GPU");
    SetUp();
    fs::remove(folder_ / "a.relief");
    expectRefused("a.relief", ErrorCode::kIo);
    SetUp();
    fs::rename(folder_ / "a.relief", folder_.parent_path() / (folder_.filename().string() + ".relief"));
    fs::create_symlink(folder_.parent_path() / (folder_.filename().string() + ".relief"),
                       folder_ / "a.relief");
    expectRefused("leads out of the world's folder");
    fs::remove(folder_.parent_path() / (folder_.filename().string() + ".relief"));
}

/// Also applies to containers that are not read now, because pages embed their bytes.
TEST_F(WorldFolder, ContainersAreNoLinksOutOfTheFolder) {
    const test::TemporaryFolder elsewhere;
    const fs::path secret = elsewhere.write("secret", "x");
    world_.colliders[0].coarse = world_.colliders[0];
    world_.colliders[0].coarse->file = "c.relief";
    fs::copy_file(folder_ / "a.relief", folder_ / "c.relief");
    EXPECT_TRUE(load(WorldDetail::kCoarse));
    fs::remove(folder_ / "a.relief");
    fs::create_symlink(secret, folder_ / "a.relief");
    const Result<LoadedWorld> loaded = load(WorldDetail::kCoarse);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find("world.json': colliders[0].file: 'a.relief' leads out"),
              std::string::npos)
        << loaded.error().message;
}

TEST_F(WorldFolder, ReadsCoarseColliders) {
    const Collider fine = collider_;
    collider_.maps = {test::makeMap(*test::makeSphere({0, 0, 0}, 0.5),
                                    test::centeredFrame({0, 0, 0}, glm::dmat3(1.0), {1.01, 1.01, 1.01}),
                                    MapFormat::kFrontBackFixed, Compare::kBoth, 16, 16)};
    const std::vector<std::byte> bytes = test::written(collider_);
    ASSERT_TRUE(writeFile(folder_ / "c.relief", bytes));
    world_.colliders[0].coarse = fileOf("c.relief", bytes);
    Result<LoadedWorld> loaded = load();
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->colliders[0], fine);
    EXPECT_EQ(worldText(loaded->world), worldText(world_));
    fs::remove(folder_ / "a.relief");
    loaded = load(WorldDetail::kCoarse);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->colliders[0], collider_);
    world_.colliders[0].coarse->hash[0] = world_.colliders[0].coarse->hash[0] == '0' ? '1' : '0';
    loaded = load(WorldDetail::kCoarse);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().message.find("colliders[0].coarse ('c.relief') does not match its hash"),
              std::string::npos)
        << loaded.error().message;
}

TEST_F(WorldFolder, BodiesAtAPointSufficeForTheField) {
    world_.bodies = {{0, "here", {0.0F, 0.0F, 0.0F}},
                     {0, "turned", {0.5F, 0.25F, 0.0F}, {0.0F, 0.6F, 0.0F, 0.8F}, 2.0F},
                     {0, "far", {900.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F, 0.0F}, 0.5F}};
    const WorldField field(required(load()));
    const Bounds& box = collider_.bounds;
    int inside = 0;
    for (int i = 0; i < 20 * 20 * 20; ++i) {
        const glm::vec3 share(glm::vec3(i % 20, i / 20 % 20, i / 400) / 19.0F * 3.0F - 1.0F);
        const glm::vec3 p = box.min + share * box.size();
        // Computed by hand, without WorldField: the second body is rotated by 2·asin(0.6) about y.
        const glm::vec3 moved = p - glm::vec3(0.5F, 0.25F, 0.0F);
        const float c = 0.28F;
        const float s = 0.96F;
        const glm::vec3 q(c * moved.x - s * moved.z, moved.y, s * moved.x + c * moved.z);
        const FieldSample first = evaluate(collider_, p);
        const FieldSample second = evaluate(collider_, q / 2.0F);
        const WorldSample all = field.evaluate(p);
        const bool near_edge = std::abs(first.distance) < 1e-4F || std::abs(second.distance) < 1e-4F;
        if (!near_edge) {
            EXPECT_EQ(all.inside(), first.inside() || second.inside()) << i;
            EXPECT_EQ(field.evaluate(p, field.bodiesIn({p, p})).inside(), all.inside()) << i;
        }
        if (all.inside()) {
            ++inside;
            EXPECT_EQ(field.evaluate(p, field.bodiesIn({p, p})).body, all.body);
            EXPECT_EQ(field.evaluate(p, field.bodiesIn({p, p})).distance, all.distance);
        }
    }
    EXPECT_GT(inside, 100);
    EXPECT_EQ(field.bodiesIn(box), (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(field.bodiesIn({glm::vec3(899.9F, 0.0F, 0.0F), glm::vec3(901.0F)}),
              std::vector<std::uint32_t>{2});
}

TEST_F(WorldFolder, PatchesAreEvaluatedWithinTheirBounds) {
    std::mt19937 random(12);
    collider_.maps = {test::randomPatches(random)};
    collider_.bounds = insideBox(collider_).value();
    writeCollider();
    world_.bodies = {{0, "a", {0.0F, 0.0F, 0.0F}},
                     {0, "b", {2.0F, 1.0F, 0.0F}, {0.0F, 0.6F, 0.0F, 0.8F}, 2.0F},
                     {0, "c", {-1.0F, 0.5F, 3.0F}, {0.5F, 0.5F, 0.5F, 0.5F}, 0.5F}};
    const WorldField field(required(load()));
    const std::vector<std::uint32_t> every{0, 1, 2};
    std::uniform_real_distribution<float> at(-8.0F, 12.0F);
    int known = 0;
    int far = 0;
    for (int i = 0; i < 20'000; ++i) {
        const glm::vec3 p(at(random), at(random), at(random));
        const WorldSample sample = field.evaluate(p);
        const WorldSample all = field.evaluate(p, every);
        ASSERT_EQ(sample.body, all.body);
        ASSERT_EQ(sample.distance, all.distance);
        ASSERT_EQ(sample.normal, all.normal);
        (sample.distance < kFarOutside ? known : far) += 1;
    }
    EXPECT_GT(known, 100);
    EXPECT_GT(far, 100);
}

TEST_F(WorldFolder, GroundBelowTheMeshBelongsToItsBody) {
    collider_.bounds.min.y = 0.4F;  // the mesh is the top of the solid
    writeCollider();
    const WorldField field(required(load()));
    const glm::vec3 below(0.01F, -0.3F, 0.02F);
    EXPECT_TRUE(field.evaluate(below).inside());
    EXPECT_EQ(field.bodiesIn({below, below}), std::vector<std::uint32_t>{0});
}

}  // namespace
}  // namespace relief
