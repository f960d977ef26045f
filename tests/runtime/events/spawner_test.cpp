// SPDX-License-Identifier: Apache-2.0
// Births caused by hits and deaths, in closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/events/event_recorder.h"
#include "runtime/events/spawner.h"

namespace relief {
namespace {

ParticleEvent hitOf(std::uint32_t id, std::uint32_t type, float speed) {
    ParticleEvent hit;
    hit.id = id;
    hit.type = type;
    hit.hit = true;
    hit.position = {static_cast<float>(id), 2.0F, 3.0F};
    hit.normal = {0.0F, 0.0F, 1.0F};
    hit.velocity = {1.0F, 2.0F, -speed};
    hit.speed = speed;
    return hit;
}

StepEvents stepOf(std::vector<ParticleEvent> events) {
    StepEvents step;
    step.events = std::move(events);
    return step;
}

std::vector<Birth> birthsOf(const SpawnSettings& settings, const std::vector<ParticleEvent>& events) {
    std::vector<Birth> births;
    EXPECT_EQ(Spawner(settings, 2).spawn(stepOf(events), {}, 10'000, births), 0U);
    return births;
}

TEST(Spawner, HitsSpawnAsConfigured) {
    const SpawnSettings settings{.parent = {},
                                 .material = {},
                                 .type = 1,
                                 .count_min = 200,
                                 .count_max = 200,
                                 .lifetime_min = 0.5F,
                                 .lifetime_max = 0.75F,
                                 .inherit = 0.5F,
                                 .speed_min = 2.0F,
                                 .speed_max = 3.0F,
                                 .kick = 0.25F,
                                 .cone_degrees = 30.0F};
    const std::vector<ParticleType> types{{}, {.radius = 0.125F}};
    std::vector<Birth> births;
    EXPECT_EQ(Spawner(settings, 4).spawn(stepOf({hitOf(7, 0, 4.0F)}), types, 1000, births), 0U);
    ASSERT_EQ(births.size(), 200U);
    float slowest = 9.0F;
    float fastest = 0.0F;
    float widest = 1.0F;
    for (const Birth& birth : births) {
        EXPECT_EQ(birth.position, glm::vec3(7.0F, 2.0F, 3.125F));
        EXPECT_EQ(birth.type, 1U);
        EXPECT_EQ(birth.age, 0.0F);
        EXPECT_TRUE(birth.lifetime >= 0.5F && birth.lifetime <= 0.75F);
        // Half of the velocity along the surface, (1, 2, 0), plus 2…3 and a quarter of 4 along the normal.
        const glm::vec3 thrown = birth.velocity - glm::vec3(0.5F, 1.0F, 0.0F);
        const float speed = glm::length(thrown);
        EXPECT_TRUE(speed >= 2.9999F && speed <= 4.0001F) << speed;
        widest = std::min(widest, thrown.z / speed);
        slowest = std::min(slowest, speed);
        fastest = std::max(fastest, speed);
    }
    EXPECT_NEAR(widest, std::cos(30.0 * 3.14159265 / 180.0), 0.01);
    EXPECT_LT(slowest, 3.05F);
    EXPECT_GT(fastest, 3.95F);
}

TEST(Spawner, OnlyMatchingEventsSpawn) {
    SpawnSettings settings{.parent = 1, .min_speed = 2.0F, .material = {}, .count_min = 3, .count_max = 3};
    auto lasting = hitOf(3, 1, 5.0F);
    lasting.lasts = true;
    ParticleEvent age;
    age.type = 1;
    age.death = true;
    auto killed = hitOf(5, 1, 1.0F);
    killed.death = true;
    const std::vector<ParticleEvent> step = {
        hitOf(0, 0, 5.0F), hitOf(1, 1, 5.0F), hitOf(2, 1, 1.9F), lasting, age, killed};
    const std::vector<Birth> hits = birthsOf(settings, step);
    ASSERT_EQ(hits.size(), 3U);
    EXPECT_EQ(hits[0].position.x, 1.0F);
    settings.on = SpawnOn::kDeath;
    EXPECT_EQ(birthsOf(settings, step).size(), 6U) << "one died of age, one was killed";
    settings.parent.reset();
    settings.on = SpawnOn::kCollision;
    settings.min_speed = 0.0F;
    EXPECT_EQ(birthsOf(settings, step).size(), 12U);
    settings.material = 4;
    auto elsewhere = hitOf(8, 0, 5.0F);
    elsewhere.material = 3;
    auto there = hitOf(9, 0, 5.0F);
    there.material = 4;
    const std::vector<Birth> own = birthsOf(settings, {hitOf(7, 0, 5.0F), elsewhere, there});
    ASSERT_EQ(own.size(), 3U);
    EXPECT_EQ(own[0].position.x, 9.0F);
}

// Births and refusals add up to all that were due, for any limits. The same seed gives the same births.
TEST(Spawner, RefusedBirthsAreCounted) {
    SpawnSettings settings{.parent = {}, .material = {}, .count_min = 2, .count_max = 6};
    std::vector<ParticleEvent> hits;
    for (std::uint32_t i = 0; i < 1000; ++i) {
        hits.push_back(hitOf(i, 0, 1.0F));
    }
    const StepEvents step = stepOf(hits);
    std::vector<Birth> all;
    EXPECT_EQ(Spawner(settings, 9).spawn(step, {}, 1'000'000, all), 0U);
    EXPECT_NEAR(static_cast<double>(all.size()), 4000.0, 200.0);
    for (const auto& [most, room] : {std::pair(10'000U, 1500U), std::pair(1234U, 50'000U)}) {
        settings.max_per_step = most;
        std::vector<Birth> some;
        const std::uint64_t rejected = Spawner(settings, 9).spawn(step, {}, room, some);
        EXPECT_EQ(some.size(), std::min(most, room));
        EXPECT_EQ(some[77].position, all[77].position);
        EXPECT_EQ(some[77].velocity, all[77].velocity);
        EXPECT_GT(rejected, 2000U);
    }
    settings.max_per_step = 10'000;
    settings.count_max = settings.count_min = 5;
    std::vector<Birth> some;
    EXPECT_EQ(Spawner(settings, 9).spawn(step, {}, 4321, some), 5000U - 4321U);
}

// A list that ends after the last usable event.
TEST(Spawner, AFilteredListGivesTheSameBirths) {
    SpawnSettings settings{.parent = 1, .min_speed = 2.0F, .material = 4, .count_max = 3, .max_per_step = 20};
    Spawner by_all(settings, 9);
    Spawner by_few(settings, 9);
    const EventOptions options = by_all.eventOptions();
    EXPECT_EQ(options, (EventOptions{.min_speed = 2.0F, .max_per_step = 20, .type = 1, .material = 4}));
    for (std::uint32_t step = 0; step < 5; ++step) {
        std::vector<ParticleEvent> all;
        std::vector<ParticleEvent> few;
        for (std::uint32_t i = 0; i < 100 + 40 * step; ++i) {
            ParticleEvent hit = hitOf(i, i % 2, i % 3 == 0 ? 1.0F : 3.0F);
            hit.material = i % 5 == 0 ? 3 : 4;
            all.push_back(hit);
            if (hit.type == options.type && hit.speed >= options.min_speed &&
                hit.material == options.material) {
                few.push_back(hit);
            }
        }
        const std::size_t dropped = few.size() - options.max_per_step;
        EXPECT_GT(few.size(), options.max_per_step);
        few.resize(options.max_per_step);
        std::vector<Birth> births;
        std::vector<Birth> same;
        const std::uint64_t rejected = by_all.spawn(stepOf(all), {}, 1000, births);
        EXPECT_EQ(by_few.spawn(stepOf(few), {}, 1000, same) + dropped, rejected);
        ASSERT_EQ(births.size(), 20U);
        ASSERT_EQ(same.size(), births.size());
        for (std::size_t i = 0; i < births.size(); ++i) {
            EXPECT_EQ(same[i].position, births[i].position);
            EXPECT_EQ(same[i].velocity, births[i].velocity);
        }
    }
    settings.on = SpawnOn::kDeath;
    settings.material.reset();
    EXPECT_EQ(Spawner(settings, 9).eventOptions(),
              (EventOptions{.hits = false, .deaths = true, .max_per_step = 20, .type = 1}));
}

TEST(Spawner, DeathsOfAgeThrowInAllDirectionsOrAlongTheVelocity) {
    ParticleEvent age;
    age.death = true;
    age.velocity = {3.0F, 0.0F, 0.0F};
    SpawnSettings settings{.on = SpawnOn::kDeath,
                           .parent = {},
                           .material = {},
                           .count_min = 3000,
                           .count_max = 3000,
                           .inherit = 2.0F,
                           .speed_min = 1.0F,
                           .speed_max = 1.0F};
    glm::vec3 mean{0.0F};
    for (const Birth& birth : birthsOf(settings, {age})) {
        const glm::vec3 thrown = birth.velocity - glm::vec3(6.0F, 0.0F, 0.0F);
        EXPECT_NEAR(glm::length(thrown), 1.0F, 1e-5F);
        mean += thrown / 3000.0F;
    }
    EXPECT_LT(glm::length(mean), 0.05F);
    settings.cone_degrees = 0.0F;
    settings.count_min = settings.count_max = 1;
    const auto thrown = [&] { return birthsOf(settings, {age}).at(0).velocity; };
    EXPECT_LT(glm::length(thrown() - glm::vec3(7.0F, 0.0F, 0.0F)), 1e-6F);
    age.velocity = {};
    EXPECT_LT(glm::length(thrown() - glm::vec3(0.0F, 1.0F, 0.0F)), 1e-6F);
}

// A lost particle's event causes no births: they count as rejected.
TEST(Spawner, LostParticlesHaveNoChildren) {
    const SpawnSettings settings{
        .parent = {}, .material = {}, .count_min = 3, .count_max = 3, .inherit = 1.0F};
    for (const float wrong : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
        ParticleEvent lost = hitOf(7, 0, 4.0F);
        lost.velocity.x = wrong;
        std::vector<Birth> births;
        EXPECT_EQ(Spawner(settings, 1).spawn(stepOf({lost, hitOf(8, 0, 4.0F)}), {}, 100, births), 3U);
        ASSERT_EQ(births.size(), 3U);
        EXPECT_EQ(births[0].position.x, 8.0F);
    }
}

}  // namespace
}  // namespace relief
