// SPDX-License-Identifier: Apache-2.0
// Worlds whose colliders come and go: the field is that of the colliders that are there, bit by bit, and nothing falls through
// while others are missing.
#include "runtime/stream/world_stream.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <deque>
#include <functional>
#include <glm/glm.hpp>
#include <random>

#include "formats/base/file_io.h"
#include "formats/base/hash.h"
#include "formats/container.h"
#include "runtime/collider/world_bodies.h"
#include "runtime/particles/particle_system.h"
#include "runtime/particles/random.h"
#include "tests/formats/random_patches.h"
#include "tests/runtime/collider/field_query.h"
#include "tests/runtime/gl/gl_test.h"
#include "tests/temporary_folder.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

Collider colliderOf(DepthMap map) {
    Collider collider;
    collider.maps = {std::move(map)};
    collider.bounds = {glm::vec3(0.1F), glm::vec3(1.9F)};
    return collider;
}

/// Brings what it has, when it is told to.
class TestSource : public ColliderSource {
  public:
    explicit TestSource(const std::vector<Collider>& colliders) : colliders_(colliders) {}

    void request(std::size_t collider) override {
        asked.push_back(collider);
        under_way_.push_back(collider);
    }
    std::optional<Arrival> take() override { return holds_back ? std::nullopt : wait(); }
    std::optional<Arrival> wait() override {
        if (under_way_.empty()) {
            return std::nullopt;
        }
        const std::size_t collider = under_way_.front();
        under_way_.pop_front();
        return Arrival{collider, collider == broken ? Result<Collider>(invalidInput("it is damaged"))
                                                    : Result<Collider>(colliders_[collider])};
    }

    bool holds_back = false;
    std::size_t broken = 999;
    std::vector<std::size_t> asked;

  private:
    const std::vector<Collider>& colliders_;
    std::deque<std::size_t> under_way_;
};

constexpr std::size_t kColliders = 6;

/// Colliders along x, ten units apart, each of its own random trees, coarse and fine.
class WorldStreamGlTest : public GlTest {
  protected:
    WorldStreamGlTest() {
        std::mt19937 random(77);
        for (std::size_t i = 0; i < kColliders; ++i) {
            fine_.push_back(colliderOf(test::randomPatches(random)));
            coarse_.push_back(colliderOf(test::randomPatches(random)));
        }
        for (std::size_t i = 0; i < kColliders; ++i) {
            const std::string name = "thing " + std::to_string(i);
            world_.colliders.push_back({{name, "", fine_[i].gpuBytes()},
                                        "",
                                        fine_[i].bounds,
                                        WorldFile{name + " coarse", "", coarse_[i].gpuBytes()}});
            coarse_bytes_ += coarse_[i].gpuBytes();
            largest_ = std::max(largest_, fine_[i].gpuBytes());
            for (int k = 0; k < 3; ++k) {
                const auto turn = static_cast<float>(i + 10 * static_cast<std::size_t>(k));
                bodies_.push_back({&coarse_[i],
                                   {{10.0F * static_cast<float>(i), 3.0F * static_cast<float>(k), 0.0F},
                                    glm::angleAxis(turn, glm::vec3(0.0F, 0.6F, 0.8F)),
                                    0.8F + 0.1F * static_cast<float>(k)}});
            }
        }
        Pcg32 places(9);
        for (std::uint32_t i = 0; i < 4000; ++i) {
            const glm::vec3 in_roots(places.between(-0.5F, 3.5F), places.between(-0.5F, 2.5F),
                                     places.between(-0.5F, 4.5F));
            points_.push_back(toWorld(bodies_[i % bodies_.size()].pose, in_roots));
        }
    }

    Result<std::unique_ptr<WorldStream>> make(const StreamOptions& options) {
        std::vector<const Collider*> coarse;
        for (const Collider& collider : coarse_) {
            coarse.push_back(&collider);
        }
        auto source = std::make_unique<TestSource>(fine_);
        source_ = source.get();
        return WorldStream::create(world_, bodies_, coarse, std::move(source), options);
    }
    void open(const StreamOptions& options) {
        auto made = required(make(options));
        stream_ = std::move(made);
    }
    void updates(int count, const std::vector<PointOfInterest>& points) {
        for (int i = 0; i < count; ++i) {
            ASSERT_TRUE(stream_->update(points));
        }
    }
    /// Compares the field with that of textures in which these colliders are fine and the others coarse.
    void expectFine(const std::vector<std::size_t>& fine) {
        std::vector<ColliderBody> bodies = bodies_;
        for (ColliderBody& body : bodies) {
            const auto index = static_cast<std::size_t>(body.collider - coarse_.data());
            if (std::ranges::find(fine, index) != fine.end()) {
                body.collider = &fine_[index];
            }
        }
        const auto textures = ColliderTextures::create(bodies);
        ASSERT_TRUE(textures) << textures.error().message;
        const std::vector<FieldSample> expected = fieldOf(*textures, points_);
        const std::vector<FieldSample> found = fieldOf(stream_->textures(), points_);
        std::size_t different = 0;
        std::size_t near = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            near += expected[i].distance < kFarOutside ? 1 : 0;
            const bool same = std::memcmp(&expected[i].distance, &found[i].distance, sizeof(float)) == 0 &&
                              expected[i].normal == found[i].normal;
            different += same ? 0 : 1;
        }
        EXPECT_EQ(different, 0U);
        EXPECT_GT(near, 500U);
    }
    /// A ball about a collider's bodies, and one about two neighbours.
    static PointOfInterest at(std::size_t collider) {
        return {{10.0F * static_cast<float>(collider), 3.0F, 0.0F}, 2.0F};
    }
    [[nodiscard]] std::vector<std::size_t> finish(const std::vector<std::size_t>& wanted) {
        source_->asked.clear();
        std::vector<PointOfInterest> points;
        for (const std::size_t collider : wanted) {
            points.push_back(at(collider));
        }
        EXPECT_TRUE(stream_->finish(points));
        return source_->asked;
    }

    std::vector<Collider> fine_;
    std::vector<Collider> coarse_;
    World world_;
    std::vector<ColliderBody> bodies_;
    std::uint64_t coarse_bytes_ = 0;
    std::uint64_t largest_ = 0;  // of the fine ones
    std::vector<glm::vec3> points_;
    std::unique_ptr<WorldStream> stream_;
    TestSource* source_ = nullptr;
};

// What is wanted, loaded, evicted and reported: the CPU decides alone, so one API is enough.
using WorldStreamBooksGlTest = WorldStreamGlTest;

TEST_P(WorldStreamGlTest, TheFieldIsThatOfWhatIsThere) {
    open({});
    EXPECT_EQ(stream_->counts().gpu_bytes, coarse_bytes_);
    expectFine({});
    EXPECT_EQ(finish({1, 4}), (std::vector<std::size_t>{1, 4}));
    EXPECT_EQ(stream_->counts().present, 2U);
    EXPECT_EQ(stream_->counts().gpu_bytes, coarse_bytes_ + fine_[1].gpuBytes() + fine_[4].gpuBytes());
    expectFine({1, 4});
    EXPECT_EQ(finish({0, 1, 2, 3, 5}), (std::vector<std::size_t>{0, 2, 3, 5}));
    expectFine({0, 1, 2, 3, 4, 5});
    EXPECT_TRUE(stream_->takeWarnings().empty());
}

TEST_P(WorldStreamGlTest, BodiesThatMoveTakeTheirMapsAlong) {
    open({});
    static_cast<void>(finish({2}));
    std::vector<Pose> poses;
    for (ColliderBody& body : bodies_) {
        body.pose.position += glm::vec3(0.5F, -0.25F, 0.125F);
        poses.push_back(body.pose);
    }
    for (int i = 0; i < 3; ++i) {  // and comes to rest
        stream_->setPoses(poses);
    }
    expectFine({2});
    for (Pose& pose : poses) {
        pose.position.x -= 10.0F;
    }
    stream_->setPoses(poses);
    EXPECT_EQ(finish({2}), std::vector<std::size_t>{3}) << "where 3 has moved to";
}

TEST_P(WorldStreamGlTest, AnUpdateCopiesSoManyBytesAndTheCoarseMapsStandInUntilAllIsThere) {
    open({.upload_bytes = 64});
    const PointOfInterest here = at(3);
    std::uint64_t before = 0;
    int updates = 0;
    while (stream_->counts().present == 0 && updates < 1000) {
        if (updates % 16 == 3) {
            expectFine({});
        }
        ASSERT_TRUE(stream_->update({&here, 1}));
        ASSERT_LE(stream_->counts().uploaded - before, 64U);
        before = stream_->counts().uploaded;
        ++updates;
    }
    EXPECT_GE(updates, static_cast<int>(fine_[3].gpuBytes() / 64));
    expectFine({3});
    EXPECT_EQ(stream_->counts().uploaded, fine_[3].gpuBytes());
}

TEST_P(WorldStreamBooksGlTest, WhatWasNotWantedForTheLongestTimeGoes) {
    // The first to go is the largest, so that its place is enough for any other.
    std::vector<std::size_t> by_size{0, 1, 2, 3, 4, 5};
    std::ranges::sort(by_size, std::greater(), [&](std::size_t i) { return fine_[i].gpuBytes(); });
    const std::size_t old = by_size[0], first = by_size[1], second = by_size[2], late = by_size[3];
    const std::uint64_t room =
        coarse_bytes_ + fine_[old].gpuBytes() + fine_[first].gpuBytes() + fine_[second].gpuBytes();
    open({.gpu_bytes = room});
    static_cast<void>(finish({first}));
    static_cast<void>(finish({old}));
    static_cast<void>(finish({first, second}));
    expectFine({old, first, second});
    EXPECT_EQ(finish({late}), std::vector<std::size_t>{late});
    EXPECT_LE(stream_->counts().gpu_bytes, room);
    EXPECT_EQ(finish({first, second}), std::vector<std::size_t>()) << "the old one has gone";
    expectFine({first, second, late});
    // More than there is room for: the nearest, and nothing is loaded in vain.
    const PointOfInterest all{{0.0F, 3.0F, 0.0F}, 200.0F};
    EXPECT_TRUE(stream_->finish({&all, 1}));
    EXPECT_EQ(stream_->counts().wanted, kColliders);
    EXPECT_GE(stream_->counts().present, 2U);
    source_->asked.clear();
    updates(10, {all});
    EXPECT_TRUE(source_->asked.empty());
}

TEST_P(WorldStreamBooksGlTest, ThereIsRoomAgainWhenWhatWasInTheWayIsNoLongerWanted) {
    open({.gpu_bytes = coarse_bytes_ + 2 * largest_});
    // In any order and number: in the end the one that alone is wanted is there, and nothing has been loaded in vain.
    Pcg32 random(12);
    for (int i = 0; i < 25; ++i) {
        std::vector<std::size_t> some;
        for (std::size_t k = 0; k < kColliders; ++k) {
            if (random.next() % 3 == 0) {
                some.push_back(k);
            }
        }
        static_cast<void>(finish(some));
        const std::uint64_t present = stream_->counts().present;
        EXPECT_GE(present, std::min<std::size_t>(some.size(), 1));
        const std::size_t alone = random.next() % kColliders;
        static_cast<void>(finish({alone}));
        EXPECT_EQ(stream_->counts().present, 1U) << alone;
        EXPECT_LE(stream_->counts().gpu_bytes, coarse_bytes_ + 2 * largest_);
    }
    EXPECT_TRUE(stream_->takeWarnings().empty());
}

TEST_P(WorldStreamBooksGlTest, TwoThatAreAsNearDoNotTakeTurns) {
    open({.gpu_bytes = coarse_bytes_ + largest_});
    for (int i = 0; i < 12; ++i) {
        const PointOfInterest between{{15.0F + (i % 2 == 0 ? 0.1F : -0.1F), 3.0F, 0.0F}, 20.0F};
        ASSERT_TRUE(stream_->finish({&between, 1}));
    }
    EXPECT_EQ(source_->asked.size(), 1U);
}

TEST_P(WorldStreamBooksGlTest, WhatIsBrokenIsNamedOnceAndItsCoarseMapsStay) {
    open({});
    source_->broken = 2;
    EXPECT_EQ(finish({1, 2}), (std::vector<std::size_t>{1, 2}));
    expectFine({1});
    EXPECT_EQ(stream_->takeWarnings().size(), 1U);
    EXPECT_EQ(finish({1, 2}), std::vector<std::size_t>());
    EXPECT_TRUE(stream_->takeWarnings().empty());
    EXPECT_EQ(stream_->counts().failed, 1U);
    fine_[3] = colliderOf(test::patchesOf({{1, 1, 1}, 0}, {PatchRecord::flat(true, {0, 1, 0}, -1.0F)}));
    static_cast<void>(finish({3}));
    EXPECT_NE(stream_->takeWarnings().at(0).find("'thing 3'"), std::string::npos);
    expectFine({1});
}

TEST_P(WorldStreamBooksGlTest, WhatIsLateWaitsForNobodyAndMayNoLongerBeWanted) {
    open({});
    source_->holds_back = true;
    updates(5, {at(1)});
    EXPECT_EQ(source_->asked, std::vector<std::size_t>{1});
    updates(1, {at(4)});
    source_->holds_back = false;
    updates(5, {at(4)});
    EXPECT_EQ(source_->asked, (std::vector<std::size_t>{1, 4}));
    expectFine({4});
}

TEST_P(WorldStreamBooksGlTest, SoManyAreUnderWayAtOnce) {
    for (const std::size_t most : {1U, 4U}) {
        open({.under_way = most});
        source_->holds_back = true;
        updates(5, {at(0), at(1), at(2), at(3), at(4)});
        EXPECT_EQ(source_->asked.size(), most);
    }
}

TEST_P(WorldStreamBooksGlTest, TooLittleMemoryIsSaid) {
    EXPECT_EQ(make({.gpu_bytes = coarse_bytes_ - 1}).error().code, ErrorCode::kLimit);
    open({.gpu_bytes = coarse_bytes_ + largest_ - 8});
    EXPECT_EQ(stream_->takeWarnings().size(), 1U);
    EXPECT_EQ(stream_->counts().failed, 1U);
    for (const float radius : {0.0F, -1.0F, std::nanf("")}) {
        const PointOfInterest none{{}, radius};
        EXPECT_FALSE(stream_->update({&none, 1}));
        EXPECT_FALSE(stream_->finish({&none, 1}));
    }
}

/// Hills in tiles of eight squares a side that overlap a little.
constexpr float kTile = 8.0F;
constexpr float kStride = 7.9375F;
constexpr int kTiles = 8;
constexpr std::uint64_t kTileBytes = 128;  // on the GPU, coarse ones too

double hill(double x, double z) {
    return 2.0 + 0.8 * std::sin(0.31 * x) + 0.7 * std::cos(0.27 * z);
}

/// \param side  heights along it: 5 or, of the coarse one, 2.
Collider tileOf(int column, int row, std::uint32_t side) {
    std::array<double, 25> heights{};
    for (std::uint32_t i = 0; i < side * side; ++i) {
        // u is along z, and fastest.
        const double x = double{kStride} * column + double{kTile} * (i / side) / (side - 1);
        const double z = double{kStride} * row + double{kTile} * (i % side) / (side - 1);
        heights[i] = hill(x, z) / kTile;
    }
    const PatchHeights codes = PatchHeights::of(std::span(heights).first(side * side), side);
    std::vector<PatchRecord> records = {PatchRecord::patch({0, 1, 0}, false, codes, 2)};
    for (std::uint32_t k = 0; k < heightTexels(side); ++k) {
        records.push_back(codes.texel(k));
    }
    Collider tile;
    tile.maps = {test::patchesOf({{1, 1, 1}, 0}, records)};
    tile.maps[0].object_to_map = {};
    for (glm::vec4& axis : tile.maps[0].object_to_map.row) {
        axis /= kTile;
    }
    tile.maps[0].object_per_map = glm::vec3(kTile);
    tile.bounds = {glm::vec3(0.0F), glm::vec3(kTile)};
    return tile;
}

/// The surface of the coarse tiles of one column and row.
double coarseHill(double x, double z, int column, int row) {
    const double x0 = double{kStride} * column;
    const double z0 = double{kStride} * row;
    const double s = (x - x0) / double{kTile};
    const double t = (z - z0) / double{kTile};
    const auto along = [&](double at) { return std::lerp(hill(x0, at), hill(x0 + double{kTile}, at), s); };
    return std::lerp(along(z0), along(z0 + double{kTile}), t);
}

/// Writes the tiles and their world. \return its path.
fs::path writeTiles(const fs::path& folder) {
    World world;
    const auto write = [&](const Collider& collider, const std::string& name) {
        const auto bytes = required(writeContainer(collider));
        EXPECT_TRUE(writeFile(folder / name, bytes));
        return WorldFile{name, xxh3_128Hex(bytes), collider.gpuBytes()};
    };
    for (int row = 0; row < kTiles; ++row) {
        for (int column = 0; column < kTiles; ++column) {
            const std::string name = std::to_string(column) + "-" + std::to_string(row);
            const Collider fine = tileOf(column, row, 5);
            WorldBody body;
            body.collider = static_cast<std::uint32_t>(world.colliders.size());
            body.position = {kStride * static_cast<float>(column), 0.0F, kStride * static_cast<float>(row)};
            world.colliders.push_back({write(fine, name + ".relief"), "", fine.bounds,
                                       write(tileOf(column, row, 2), name + "-coarse.relief")});
            world.bodies.push_back(body);
        }
    }
    const std::string text = worldText(world);
    EXPECT_TRUE(writeFile(folder / "world.json", std::as_bytes(std::span(text))));
    return folder / "world.json";
}

/// Drops rain on tiles that come and go below it. \param finish  in place of update().
std::vector<ParticleState> flight(WorldStream& world, bool finish) {
    auto particles = ParticleSystem::create({.capacity = 2048});
    EXPECT_TRUE(particles);
    EXPECT_TRUE(particles->setCollider(&world.textures()));
    EXPECT_TRUE(particles->setForces({.gravity = {0.0F, -9.81F, 0.0F}}));
    EXPECT_TRUE(particles->setCollision({.restitution = 0.0F, .friction = 1.0F}));
    Pcg32 random(6);
    std::vector<Birth> births;
    const float side = kStride * (kTiles - 1);
    for (int i = 0; i < 2048; ++i) {
        births.push_back(
            {{random.between(0.2F, side), random.between(4.5F, 6.0F), random.between(0.2F, side)},
             {},
             100.0F});
    }
    EXPECT_EQ(particles->spawn(births), 2048U);
    for (int step = 0; step < 160; ++step) {
        const float way = static_cast<float>(step) / 160.0F * side;
        const std::array<PointOfInterest, 1> points = {{{{way, 3.0F, 0.5F * side}, 10.0F}}};
        EXPECT_TRUE(finish ? world.finish(points) : world.update(points));
        EXPECT_TRUE(particles->step(1.0F / 60.0F));
    }
    const auto state = particles->readState();
    EXPECT_TRUE(state);
    return *state;
}

TEST_P(WorldStreamGlTest, NothingFallsThroughTilesThatComeAndGo) {
    const test::TemporaryFolder folder;
    const fs::path path = writeTiles(folder.path());
    const std::uint64_t bytes = kTileBytes * (kTiles * kTiles + 16);
    for (const bool finish : {false, true}) {
        auto world = required(WorldStream::open(path, {.gpu_bytes = bytes, .upload_bytes = 32}));
        const std::vector<ParticleState> state = flight(*world, finish);
        std::size_t resting = 0;
        std::size_t deeper = 0;
        for (const ParticleState& particle : state) {
            // It lies on either likeness of its tile: both are off by up to 0.07, and the last step of a fall is one of 0.14. A few
            // were at rest when the maps changed, and are on their way out.
            const double x = particle.position.x;
            const double z = particle.position.z;
            const double y = particle.position.y;
            const double coarse = coarseHill(x, z, static_cast<int>(x / double{kStride}),
                                             static_cast<int>(z / double{kStride}));
            ASSERT_GT(y, std::min(hill(x, z), coarse) - 0.6) << x << " " << z;
            ASSERT_LT(y, std::max(hill(x, z), coarse) + 0.21) << x << " " << z;
            deeper += y < std::min(hill(x, z), coarse) - 0.21 ? 1 : 0;
            resting += glm::length(particle.velocity) < 0.2F ? 1 : 0;
        }
        EXPECT_GT(resting, 1500U) << "the others fall, or come out, where maps have changed";
        EXPECT_LT(deeper, 20U);
        EXPECT_TRUE(world->takeWarnings().empty());
        if (finish) {
            EXPECT_GT(world->counts().uploaded, 20 * kTileBytes);
            auto again = WorldStream::open(path, {.gpu_bytes = bytes, .upload_bytes = 800});
            ASSERT_TRUE(again);
            const std::vector<ParticleState> same = flight(**again, true);
            for (std::size_t i = 0; i < state.size(); ++i) {
                ASSERT_EQ(same[i].position, state[i].position);
                ASSERT_EQ(same[i].velocity, state[i].velocity);
            }
        }
    }
}

TEST_P(WorldStreamBooksGlTest, FilesThatAreMissingOrOthersAreNamed) {
    const test::TemporaryFolder folder;
    const fs::path path = writeTiles(folder.path());
    fs::remove(folder.path() / "3-4.relief");
    fs::remove(folder.path() / "5-5.relief");
    fs::copy_file(folder.path() / "1-1.relief", folder.path() / "5-5.relief");
    auto world = required(WorldStream::open(path));
    const PointOfInterest all{{30.0F, 0.0F, 30.0F}, 200.0F};
    EXPECT_TRUE(world->finish({&all, 1}));
    EXPECT_EQ(world->counts().present, std::size_t{kTiles * kTiles - 2});
    const std::vector<std::string> warnings = world->takeWarnings();
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_NE((warnings[0] + warnings[1]).find("3-4.relief"), std::string::npos);
    EXPECT_NE((warnings[0] + warnings[1]).find("'5-5.relief') has other contents"), std::string::npos)
        << warnings[0] << warnings[1];
    fs::remove(folder.path() / "7-7-coarse.relief");
    EXPECT_FALSE(WorldStream::open(path)) << "there is nothing to stand in";
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(WorldStreamGlTest);
INSTANTIATE_TEST_SUITE_P(Apis, WorldStreamBooksGlTest, testing::Values(GlApi::kGl33Core), glApiTestName);

}  // namespace relief
