// SPDX-License-Identifier: Apache-2.0
// Worlds whose colliders are loaded and evicted: the field is bit-identical to that of the present colliders, and
// particles do not fall through while others are missing.
#include "runtime/bodies/world_textures.h"
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
#include "runtime/bodies/world_bodies.h"
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

/// Delivers colliders on request of the test.
class TestSource : public ColliderSource {
  public:
    explicit TestSource(const std::vector<Collider>& colliders) : colliders_(colliders) {}

    void request(std::size_t collider) override {
        requested.push_back(collider);
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
    std::vector<std::size_t> requested;

  private:
    const std::vector<Collider>& colliders_;
    std::deque<std::size_t> under_way_;
};

constexpr std::size_t kColliders = 6;

/// Colliders along x, ten units apart, each with its own random trees, coarse and fine.
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
            world_.colliders.push_back({{name, "", fine_[i].texelBytes()},
                                        "",
                                        fine_[i].bounds,
                                        WorldFile{name + " coarse", "", coarse_[i].texelBytes()}});
            coarse_bytes_ += coarse_[i].texelBytes();
            largest_ = std::max(largest_, fine_[i].texelBytes());
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
    void open(const StreamOptions& options) { stream_ = required(make(options)); }
    void updates(int count, const std::vector<PointOfInterest>& points) {
        for (int i = 0; i < count; ++i) {
            ASSERT_TRUE(stream_->update(points));
        }
    }
    /// Compares the field with that of textures in which these colliders are fine and all others coarse.
    void expectFine(const std::vector<std::size_t>& fine) {
        std::vector<ColliderBody> bodies = bodies_;
        for (ColliderBody& body : bodies) {
            const auto index = static_cast<std::size_t>(body.collider - coarse_.data());
            if (std::ranges::find(fine, index) != fine.end()) {
                body.collider = &fine_[index];
            }
        }
        const std::vector<FieldSample> expected = fieldOf(required(WorldTextures::create(bodies)), points_);
        const std::vector<FieldSample> found = fieldOf(stream_->textures(), points_);
        std::size_t near = 0;
        for (std::size_t i = 0; i < points_.size(); ++i) {
            near += expected[i].distance < kFarOutside ? 1 : 0;
            ASSERT_EQ(std::memcmp(&expected[i].distance, &found[i].distance, sizeof(float)), 0) << i;
            ASSERT_EQ(expected[i].normal, found[i].normal) << i;
        }
        EXPECT_GT(near, 500U);
    }
    /// A ball around a collider's bodies, and one around two neighbours.
    static PointOfInterest at(std::size_t collider) {
        return {{10.0F * static_cast<float>(collider), 3.0F, 0.0F}, 2.0F};
    }
    [[nodiscard]] std::vector<std::size_t> finish(const std::vector<std::size_t>& wanted) {
        source_->requested.clear();
        std::vector<PointOfInterest> points;
        for (const std::size_t collider : wanted) {
            points.push_back(at(collider));
        }
        EXPECT_TRUE(stream_->finish(points));
        return source_->requested;
    }

    std::vector<Collider> fine_;
    std::vector<Collider> coarse_;
    World world_;
    std::vector<ColliderBody> bodies_;
    std::uint64_t coarse_bytes_ = 0;
    std::uint64_t largest_ = 0;  // size of the largest fine collider
    std::vector<glm::vec3> points_;
    std::unique_ptr<WorldStream> stream_;
    TestSource* source_ = nullptr;
};

// Only the CPU decides what is wanted, loaded, evicted and reported, so one API is enough.
using WorldStreamPolicyGlTest = WorldStreamGlTest;

TEST_P(WorldStreamGlTest, FieldMatchesThePresentColliders) {
    open({});
    EXPECT_EQ(stream_->counts().gpu_bytes, coarse_bytes_);
    expectFine({});
    EXPECT_EQ(finish({1, 4}), (std::vector<std::size_t>{1, 4}));
    EXPECT_EQ(stream_->counts().present, 2U);
    EXPECT_EQ(stream_->counts().gpu_bytes, coarse_bytes_ + fine_[1].texelBytes() + fine_[4].texelBytes());
    expectFine({1, 4});
    EXPECT_EQ(finish({0, 1, 2, 3, 5}), (std::vector<std::size_t>{0, 2, 3, 5}));
    expectFine({0, 1, 2, 3, 4, 5});
    EXPECT_TRUE(stream_->takeWarnings().empty());
}

TEST_P(WorldStreamGlTest, MovingBodiesKeepTheirMaps) {
    open({});
    static_cast<void>(finish({2}));
    std::vector<Pose> poses;
    for (ColliderBody& body : bodies_) {
        body.pose.position += glm::vec3(0.5F, -0.25F, 0.125F);
        poses.push_back(body.pose);
    }
    for (int i = 0; i < 3; ++i) {  // then comes to rest
        stream_->setPoses(poses);
    }
    expectFine({2});
    for (Pose& pose : poses) {
        pose.position.x -= 10.0F;
    }
    stream_->setPoses(poses);
    EXPECT_EQ(finish({2}), std::vector<std::size_t>{3}) << "3 has moved there";
}

TEST_P(WorldStreamGlTest, CoarseMapsAreUsedUntilTheUploadIsComplete) {
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
    EXPECT_GE(updates, static_cast<int>(fine_[3].texelBytes() / 64));
    expectFine({3});
    EXPECT_EQ(stream_->counts().uploaded, fine_[3].texelBytes());
}

TEST_P(WorldStreamPolicyGlTest, LeastRecentlyWantedIsEvicted) {
    // The first to be evicted is the largest, so that its memory suffices for any other.
    std::vector<std::size_t> by_size{0, 1, 2, 3, 4, 5};
    std::ranges::sort(by_size, std::greater(), [&](std::size_t i) { return fine_[i].texelBytes(); });
    const std::size_t old = by_size[0], first = by_size[1], second = by_size[2], late = by_size[3];
    const std::uint64_t room =
        coarse_bytes_ + fine_[old].texelBytes() + fine_[first].texelBytes() + fine_[second].texelBytes();
    open({.gpu_bytes = room});
    static_cast<void>(finish({first}));
    static_cast<void>(finish({old}));
    static_cast<void>(finish({first, second}));
    expectFine({old, first, second});
    EXPECT_EQ(finish({late}), std::vector<std::size_t>{late});
    EXPECT_LE(stream_->counts().gpu_bytes, room);
    EXPECT_EQ(finish({first, second}), std::vector<std::size_t>()) << "the least recently wanted was evicted";
    expectFine({first, second, late});
    // More colliders than fit: the nearest are loaded, and nothing is loaded in vain.
    const PointOfInterest all{{0.0F, 3.0F, 0.0F}, 200.0F};
    EXPECT_TRUE(stream_->finish({&all, 1}));
    EXPECT_EQ(stream_->counts().wanted, kColliders);
    EXPECT_GE(stream_->counts().present, 2U);
    source_->requested.clear();
    updates(10, {all});
    EXPECT_TRUE(source_->requested.empty());
}

TEST_P(WorldStreamPolicyGlTest, UnwantedCollidersMakeRoom) {
    open({.gpu_bytes = coarse_bytes_ + 2 * largest_});
    // In any order and number: in the end the only wanted collider is present, and nothing was loaded in vain.
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
        const std::size_t only = random.next() % kColliders;
        static_cast<void>(finish({only}));
        EXPECT_EQ(stream_->counts().present, 1U) << only;
        EXPECT_LE(stream_->counts().gpu_bytes, coarse_bytes_ + 2 * largest_);
    }
    EXPECT_TRUE(stream_->takeWarnings().empty());
}

TEST_P(WorldStreamPolicyGlTest, EquallyNearCollidersDoNotAlternate) {
    open({.gpu_bytes = coarse_bytes_ + largest_});
    for (int i = 0; i < 12; ++i) {
        const PointOfInterest between{{15.0F + (i % 2 == 0 ? 0.1F : -0.1F), 3.0F, 0.0F}, 20.0F};
        ASSERT_TRUE(stream_->finish({&between, 1}));
    }
    EXPECT_EQ(source_->requested.size(), 1U);
}

TEST_P(WorldStreamPolicyGlTest, BrokenCollidersAreReportedOnceAndStayCoarse) {
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

TEST_P(WorldStreamPolicyGlTest, LateLoadsDoNotBlockAndMayBeDiscarded) {
    open({});
    source_->holds_back = true;
    updates(5, {at(1)});
    EXPECT_EQ(source_->requested, std::vector<std::size_t>{1});
    updates(1, {at(4)});
    source_->holds_back = false;
    updates(5, {at(4)});
    EXPECT_EQ(source_->requested, (std::vector<std::size_t>{1, 4}));
    expectFine({4});
}

TEST_P(WorldStreamPolicyGlTest, ConcurrentLoadsAreLimited) {
    for (const std::size_t most : {1U, 4U}) {
        open({.under_way = most});
        source_->holds_back = true;
        updates(5, {at(0), at(1), at(2), at(3), at(4)});
        EXPECT_EQ(source_->requested.size(), most);
    }
}

TEST_P(WorldStreamPolicyGlTest, TooLittleMemoryIsReported) {
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

// Drops rest on the fine or the coarse plane of a tile, whichever is present; the two are half a unit apart.
TEST_P(WorldStreamGlTest, NothingFallsThroughStreamedTiles) {
    const auto plane = [](double height) {
        const PatchHeights codes = PatchHeights::of(std::vector(4, height), 2);
        Collider tile =
            colliderOf(test::patchesOf({{1, 1, 1}, 0}, {PatchRecord::patch({0, 1, 0}, false, codes, 0)}));
        tile.bounds = {glm::vec3(0.0F), glm::vec3(1.0F)};
        return tile;
    };
    bodies_.clear();
    const std::uint64_t bytes = plane(0.5).texelBytes();
    for (std::size_t i = 0; i < kColliders; ++i) {
        fine_[i] = plane(0.5);
        coarse_[i] = plane(0.45);
        world_.colliders[i].gpu_bytes = world_.colliders[i].coarse->gpu_bytes = bytes;
        bodies_.push_back({&coarse_[i], {{9.95F * static_cast<float>(i), 0.0F, 0.0F}, {1, 0, 0, 0}, 10.0F}});
    }
    std::vector<std::vector<ParticleState>> ends;
    for (const auto& [finish, upload] : {std::pair(false, 8U), {true, 8U}, {true, 800U}}) {
        open({.gpu_bytes = (kColliders + 3) * bytes, .upload_bytes = upload});
        ParticleSystem particles = required(ParticleSystem::create({.capacity = 512}));
        ASSERT_TRUE(particles.setCollider(&stream_->textures()));
        ASSERT_TRUE(particles.setForces({.gravity = {0.0F, -9.81F, 0.0F}}));
        ASSERT_TRUE(particles.setType({.friction = 1.0F}));
        Pcg32 random(6);
        std::vector<Birth> births;
        for (int i = 0; i < 512; ++i) {
            const float x = random.between(0.2F, 59.0F);
            births.push_back({{x, random.between(6.0F, 7.0F), random.between(0.2F, 9.8F)}, {}, 100.0F});
        }
        ASSERT_EQ(required(particles.spawn(births)), births.size());
        for (int step = 0; step < 160; ++step) {
            const PointOfInterest here{{0.375F * static_cast<float>(step), 5.0F, 5.0F}, 10.0F};
            ASSERT_TRUE(finish ? stream_->finish({&here, 1}) : stream_->update({&here, 1}));
            ASSERT_TRUE(particles.step(1.0F / 60.0F));
            if (step % 53 != 52) {
                continue;
            }
            const std::vector<ParticleState>& state = ends.emplace_back(required(particles.readState()));
            const auto coarse =
                std::ranges::count_if(state, [](const auto& p) { return p.position.y < 4.9F; });
            EXPECT_TRUE(step > 52 || (coarse > 100 && coarse < 400)) << coarse;
            for (const ParticleState& particle : state) {
                ASSERT_GT(particle.position.y, 4.5F - 0.01F) << particle.position.x;
            }
        }
        EXPECT_GT(stream_->counts().uploaded, 4 * bytes);
        EXPECT_TRUE(stream_->takeWarnings().empty());
    }
    ASSERT_EQ(ends.size(), 9U);
    for (std::size_t i = 0; i < ends[3].size(); ++i) {
        ASSERT_EQ(ends[3][i].position, ends[6][i].position) << "finish() does not depend on upload_bytes";
    }
}

TEST_P(WorldStreamPolicyGlTest, MissingAndReplacedFilesAreNamed) {
    const test::TemporaryFolder folder;
    const auto write = [&](WorldFile& file, const Collider& collider) {
        const std::vector<std::byte> bytes = required(writeContainer(collider));
        EXPECT_TRUE(writeFile(folder.path() / file.file, bytes));
        file.hash = xxh3_128Hex(bytes);
    };
    for (std::size_t i = 0; i < kColliders; ++i) {
        write(world_.colliders[i], fine_[i]);
        write(*world_.colliders[i].coarse, coarse_[i]);
        world_.bodies.push_back({.collider = static_cast<std::uint32_t>(i)});
    }
    const fs::path path = folder.write("world.json", worldText(world_));
    fs::remove(folder.path() / "thing 3");
    fs::remove(folder.path() / "thing 5");
    fs::copy_file(folder.path() / "thing 1", folder.path() / "thing 5");
    const auto world = required(WorldStream::open(path));
    const PointOfInterest all{{}, 200.0F};
    EXPECT_TRUE(world->finish({&all, 1}));
    EXPECT_EQ(world->counts().present, kColliders - 2);
    const std::vector<std::string> warnings = world->takeWarnings();
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_NE((warnings[0] + warnings[1]).find("thing 3"), std::string::npos);
    EXPECT_NE((warnings[0] + warnings[1]).find("'thing 5') does not match its hash"), std::string::npos)
        << warnings[0] << warnings[1];
    fs::remove(folder.path() / "thing 2 coarse");
    EXPECT_FALSE(WorldStream::open(path)) << "there is no coarse collider";
}

}  // namespace

RELIEF_INSTANTIATE_GL_TESTS(WorldStreamGlTest);
INSTANTIATE_TEST_SUITE_P(Apis, WorldStreamPolicyGlTest, testing::Values(GlApi::kGl33Core), glApiTestName);

}  // namespace relief
