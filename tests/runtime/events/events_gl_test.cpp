// SPDX-License-Identifier: Apache-2.0
// The event list of a step: closed forms, counts that must agree with the particles, and no effect if nobody requests
// it. step_path_gl_test.cpp compares the step paths.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "runtime/bodies/world_textures.h"
#include "runtime/events/event_recorder.h"
#include "runtime/particles/random.h"
#include "tests/runtime/particles/collision_test.h"

namespace relief {
namespace {

class EventsGlTest : public CollisionTest {};

// A ball of radius r at height h above the floor, initially at rest. After n steps of semi-implicit Euler its height is
// h - g dt² n (n + 1) / 2 and its speed is g dt n; its path is straight within a step. It stops on contact.
TEST_P(EventsGlTest, DroppedBallsHitOnceAsInTheClosedForm) {
    constexpr double kG = 9.81;
    constexpr double kH = 1.7;
    constexpr double kR = 0.13;
    constexpr double kGround = 0.25;
    const auto dt = static_cast<double>(kDt);
    int n = 1;
    const auto bottom = [&](int steps) { return kH - kR - kGround - kG * dt * dt * steps * (steps + 1) / 2; };
    while (bottom(n) > 0) {
        ++n;
    }
    const double share = bottom(n - 1) / (bottom(n - 1) - bottom(n));
    for (const auto& [integrator, sweep] :
         {std::pair(Integrator::kEuler, 0.0F), std::pair(Integrator::kVerlet, 0.0F),
          std::pair(Integrator::kVerlet, 0.03F)}) {
        SCOPED_TRACE(std::string(integrator == Integrator::kVerlet ? "Verlet" : "Euler") +
                     (sweep > 0.0F ? ", swept" : ""));
        make({.capacity = 10, .integrator = integrator});
        ASSERT_TRUE(particles_->setSweep(sweep));
        EXPECT_TRUE(particles_->setForces({.gravity = {0.0F, static_cast<float>(-kG), 0.0F}}));
        EXPECT_TRUE(particles_->setGround(static_cast<float>(kGround)));
        setType({.radius = static_cast<float>(kR), .on_collision = OnCollision::kStop});
        ASSERT_TRUE(setEvents(*particles_, EventOptions{.lasting = true}));
        const std::vector<Birth> births{
            {{5.0F, 100.0F, 0.0F}, {}, 100.0F, 0},
            {{0.5F, static_cast<float>(kH), -2.0F}, {0.3F, 0.0F, 0.0F}, 100.0F, 7}};
        ASSERT_EQ(particles_->spawn(births), 2U);
        std::size_t hits = 0;
        for (int step = 1; step <= 2 * n; ++step) {
            particles_->step(kDt);
            const StepEvents got = takeEvents(static_cast<std::uint64_t>(step));
            EXPECT_EQ(got.tag, static_cast<std::uint64_t>(step));
            EXPECT_EQ(got.time, particles_->time());
            EXPECT_EQ(got.dropped, 0U);
            for (const ParticleEvent& hit : got.events) {
                ++hits;
                const double time = (n - 1 + share) * dt;
                EXPECT_EQ(step, n);
                EXPECT_TRUE(hit.hit && !hit.lasts && !hit.death);
                EXPECT_TRUE(hit.id == 1 && hit.index == 1 && hit.type == 7 && hit.body == -1);
                EXPECT_NEAR(hit.time, time, 2e-5);
                EXPECT_NEAR(hit.speed, kG * dt * n, 1e-4);
                EXPECT_EQ(hit.normal, glm::vec3(0.0F, 1.0F, 0.0F));
                EXPECT_LT(glm::length(hit.position - glm::vec3(0.5 + 0.3 * time, kGround, -2.0)), 1.5e-5F);
                EXPECT_LT(glm::length(hit.velocity - glm::vec3(0.3, -kG * dt * n, 0.0)), 1e-4F);
            }
        }
        EXPECT_EQ(hits, 1U);
    }
}

// A plate that moves against the particle: speed is relative to the plate, and the hit is where both meet.
TEST_P(EventsGlTest, HitsAreRelativeToMovingBodies) {
    const Collider box = boxCollider();  // its top is at 0.2
    make({.capacity = 4});
    collideWith(ColliderBody{&box, {{0.0F, -1.0F, 0.0F}}});
    ASSERT_TRUE(setEvents(*particles_, EventOptions{}));
    spawnOne({{0.05F, 0.3F, 0.07F}, {0.0F, -1.2F, 0.0F}, 100.0F, 0});
    constexpr double kUp = 1.8;
    std::size_t hits = 0;
    for (int step = 1; step <= 25; ++step) {
        setPose({{0.0F, static_cast<float>(-1.0 + kUp * step * static_cast<double>(kDt)), 0.0F}});
        particles_->step(kDt);
        for (const ParticleEvent& hit : takeEvents().events) {
            ++hits;
            const double meet = 1.1 / (1.2 + kUp);
            EXPECT_NEAR(hit.time, meet, 2e-5);
            EXPECT_NEAR(hit.position.y, 0.3 - 1.2 * meet, 2e-5);
            EXPECT_NEAR(hit.speed, 1.2 + kUp, 1e-4);
            EXPECT_NEAR(hit.velocity.y, -1.2, 1e-5);
            EXPECT_EQ(hit.body, 0);
            EXPECT_LT(glm::length(hit.normal - glm::vec3(0.0F, 1.0F, 0.0F)), 1e-3F);
        }
        if (hits > 0) {
            break;
        }
    }
    EXPECT_EQ(hits, 1U);
}

struct Played {
    std::vector<StepEvents> events;
    std::vector<ParticleState> state;
    std::map<std::uint32_t, std::uint32_t> caught;  // steps in which each id was pushed out from inside
    std::unique_ptr<WorldTextures> textures;        // used by the particles
};

/// Particles on a box and a floor, some of which die. They span many rows and levels.
Played played(ParticleSystem& particles, std::uint32_t count, int steps, OnCollision reaction, bool ask,
              bool count_caught = false) {
    Played out;
    out.textures = std::make_unique<WorldTextures>(required(WorldTextures::create(boxCollider())));
    EXPECT_TRUE(particles.setCollider(out.textures.get()));
    EXPECT_TRUE(particles.setForces({{0.1F, -3.0F, 0.0F}, {0.4F, 0.0F, -0.3F}, 0.5F}));
    EXPECT_TRUE(particles.setGround(-0.7F));
    ParticleType type;
    type.restitution = 0.5F;
    type.friction = 0.2F;
    type.on_collision = reaction;
    EXPECT_TRUE(particles.setTypes(std::span(&type, 1)));
    Pcg32 random(5);
    for (int step = 0; step < steps; ++step) {
        std::vector<Birth> births;
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::vec3 place = randomIn(random, {-0.8F, 0.3F, -0.8F}, {0.8F, 0.8F, 0.8F});
            const glm::vec3 speed = randomIn(random, {-1.0F, -3.0F, 0.0F}, {1.0F, 0.0F, 0.0F});
            births.push_back({place, speed, random.between(0.2F, 2.0F), i % 5});
        }
        particles.spawn(births);
        particles.step(kDt);
        if (ask) {
            EXPECT_TRUE(requestEvents(particles, static_cast<std::uint64_t>(step)));
        }
        if (count_caught) {
            for (const ParticleState& particle : required(particles.readState())) {
                out.caught[particle.id] += particle.contact == Contact::kCaught ? 1 : 0;
            }
        }
        // Reads back some steps later, when indices have been reused.
        while (eventsInFlight(particles) > (step + 1 < steps ? 4 : 0)) {
            out.events.push_back(required(waitEvents(particles)).value());
        }
    }
    out.state = required(particles.readState());
    return out;
}

// Every step in contact is a hit, except if the particle was found inside. With all hits listed, including lasting
// contacts, the sums agree for each particle. A particle killed by a hit dies once: hit and death are one event, with
// no later death of age.
TEST_P(EventsGlTest, HitsMatchTheCollisionsOfEachParticle) {
    for (const OnCollision reaction : {OnCollision::kBounce, OnCollision::kDie}) {
        const bool kills = reaction == OnCollision::kDie;
        SCOPED_TRACE(kills);
        make({.capacity = 5000, .epoch_seconds = 0.5});
        ASSERT_TRUE(setEvents(*particles_, EventOptions{.lasting = true, .deaths = true}));
        Played run = played(*particles_, 40, 150, reaction, true, true);
        std::map<std::uint32_t, std::uint32_t> hits;
        std::set<std::uint32_t> dead;
        for (const StepEvents& step : run.events) {
            std::uint32_t last = 0;
            for (std::size_t i = 0; i < step.events.size(); ++i) {
                const ParticleEvent& event = step.events[i];
                EXPECT_TRUE(i == 0 || event.index > last) << "not in index order";
                last = event.index;
                EXPECT_EQ(event.type, event.id % 40 % 5);
                EXPECT_GT(event.time, step.time - 1.01 * static_cast<double>(kDt));
                EXPECT_LE(event.time, step.time + 1e-6);
                EXPECT_FALSE(dead.contains(event.id)) << "an event of a dead particle";
                EXPECT_TRUE(event.death || (event.hit && !kills));
                hits[event.id] += event.hit ? 1 : 0;
                EXPECT_TRUE(!event.hit || std::abs(glm::length(event.normal) - 1.0F) < 1e-5F);
                if (event.death) {
                    dead.insert(event.id);
                }
            }
        }
        const auto touched =
            std::count_if(hits.begin(), hits.end(), [](const auto& of) { return of.second > 0; });
        EXPECT_GT(touched, 1000);
        EXPECT_TRUE(kills || dead.size() == particles_->counts().died);
        EXPECT_GT(dead.size(), kills ? static_cast<std::size_t>(touched) : 1000U);
        for (const ParticleState& particle : run.state) {
            EXPECT_EQ(hits[particle.id] + run.caught[particle.id], particle.collisions) << particle.id;
            EXPECT_FALSE(dead.contains(particle.id));
        }
        EXPECT_EQ(dead.size() + run.state.size(), particles_->counts().born);
    }
}

// The extent shrinks when particles die, and the clock may be set back in the same step. Their events keep time,
// position, id and type.
TEST_P(EventsGlTest, DeathsAtTheEndOfTheExtentAreListed) {
    constexpr std::uint32_t kMany = 2500;
    const auto dt = static_cast<double>(kDt);
    make({.capacity = kMany, .epoch_seconds = 2.9 * dt});
    ASSERT_TRUE(setEvents(*particles_, EventOptions{.hits = false, .deaths = true}));
    spawnMany(kMany, [](std::uint32_t i) {
        return Birth{glm::vec3(i, 0.0F, 0.0F), {0.0F, 6.0F, 0.0F}, i == 0 ? 100.0F : 2.5F * kDt, i % 7};
    });
    for (int step = 1; step <= 3; ++step) {
        particles_->step(kDt);
        const StepEvents events = takeEvents();
        ASSERT_EQ(events.events.size(), step == 3 ? kMany - 1 : 0U);
        for (std::uint32_t i = 1; step == 3 && i < kMany; ++i) {
            const ParticleEvent& event = events.events[i - 1];
            ASSERT_TRUE(event.death && !event.hit && event.id == i && event.index == i && event.type == i % 7)
                << i;
            ASSERT_NEAR(event.time, 2.5 * dt, 1e-5);
            ASSERT_LT(glm::length(event.position - glm::vec3(i, 15.0F * kDt, 0.0F)), 1e-4F);
        }
    }
    EXPECT_EQ(particles_->extent(), 1U);
}

TEST_P(EventsGlTest, RequestsDoNotChangeParticles) {
    std::vector<std::vector<ParticleState>> states;
    for (const bool ask : {false, true}) {
        make({.capacity = 5000});
        EXPECT_EQ(eventList(*particles_), nullptr);
        EXPECT_FALSE(requestEvents(*particles_, 0));
        EXPECT_FALSE(required(waitEvents(*particles_)));
        ASSERT_TRUE(!ask || setEvents(*particles_, EventOptions{}));
        states.push_back(played(*particles_, 30, 60, OnCollision::kBounce, ask).state);
        ASSERT_TRUE(particles_->setCollider(nullptr));
    }
    ASSERT_EQ(states[0].size(), states[1].size());
    ASSERT_GT(states[0].size(), 500U);
    for (std::size_t i = 0; i < states[0].size(); ++i) {
        const ParticleState& a = states[0][i];
        const ParticleState& b = states[1][i];
        EXPECT_TRUE(a.id == b.id && a.position == b.position && a.velocity == b.velocity &&
                    a.collisions == b.collisions)
            << a.id;
    }
    ASSERT_TRUE(setEvents(*particles_, std::nullopt));
    particles_->step(kDt);
    EXPECT_FALSE(requestEvents(*particles_, 0));
}

// Enough hits in one step to need every level of counts.
TEST_P(EventsGlTest, AQuarterOfAMillionHitsAreListed) {
    constexpr std::uint32_t kMany = (1U << 18) + 1000;
    make({.capacity = kMany});
    EXPECT_TRUE(particles_->setGround(0.0F));
    ASSERT_TRUE(setEvents(*particles_, EventOptions{.max_per_step = ParticleSystem::kCapacityMax}));
    spawnMany(kMany, [](std::uint32_t i) {
        return Birth{glm::vec3(i, 0.01F, 0.0F), {0.0F, i % 3 == 0 ? 1.0F : -2.0F, 0.0F}};
    });
    particles_->step(kDt);
    const StepEvents events = takeEvents();
    ASSERT_EQ(events.events.size(), kMany - (kMany + 2) / 3);
    EXPECT_EQ(events.dropped, 0U);
    for (std::size_t i = 0; i < events.events.size(); ++i) {
        const auto id = static_cast<std::uint32_t>(3 * (i / 2) + 1 + i % 2);
        ASSERT_EQ(events.events[i].id, id);
        ASSERT_EQ(events.events[i].position, glm::vec3(id, 0.0F, 0.0F));
    }
}

// Alone or with others in one request, a list contains the events that match its options, in index order. A short list
// keeps the lowest indices and counts the dropped events.
TEST_P(EventsGlTest, ListsMatchTheirOptions) {
    const auto run = [&](std::span<const EventOptions> lists) {
        make({.capacity = 70'000});
        EXPECT_TRUE(setEvents(*particles_, lists));
        return played(*particles_, 1500, 25, OnCollision::kBounce, true).events;
    };
    const EventOptions everything{.lasting = true, .deaths = true};
    const std::vector<StepEvents> all = run(std::span(&everything, 1));
    ASSERT_EQ(all.size(), 25U);
    const std::vector<EventOptions> options{{.lasting = true, .max_per_step = 1500, .type = 2},
                                            {.min_speed = 1.5F, .max_per_step = 7},
                                            {.hits = false, .deaths = true},
                                            {.lasting = true, .max_per_step = 2000, .type = 4}};
    for (const std::size_t count : {1U, 2U, 3U, 4U}) {
        const std::vector<StepEvents> some = run(std::span(options).first(count));
        ASSERT_EQ(some.size(), all.size());
        for (std::size_t list = 0; list < count; ++list) {
            SCOPED_TRACE(std::to_string(list) + " of " + std::to_string(count));
            const EventOptions& own = options[list];
            std::size_t listed = 0;
            std::size_t dropped = 0;
            std::size_t others = 0;
            for (std::size_t step = 0; step < all.size(); ++step) {
                std::vector<ParticleEvent> wanted = all[step].events;
                others += std::erase_if(wanted, [&](const ParticleEvent& event) {
                    const bool hit = own.hits && event.hit && event.speed >= own.min_speed &&
                                     (own.lasting || !event.lasts);
                    return !(hit || (own.deaths && event.death)) ||
                           event.type != own.type.value_or(event.type);
                });
                const std::size_t most = std::min<std::size_t>(wanted.size(), own.max_per_step);
                const std::span<const ParticleEvent> got = some[step].of(list);
                ASSERT_EQ(got.size(), most) << step;
                ASSERT_EQ(some[step].lists[list].dropped, wanted.size() - most) << step;
                for (std::size_t i = 0; i < most; ++i) {
                    ASSERT_TRUE(got[i].id == wanted[i].id && got[i].index == wanted[i].index &&
                                got[i].position == wanted[i].position && got[i].speed == wanted[i].speed);
                }
                listed += most;
                dropped += wanted.size() - most;
            }
            EXPECT_GT(listed, 100U);
            EXPECT_GT(others, 100U);
            EXPECT_EQ(dropped > 100, own.max_per_step == 7);
        }
    }
}

TEST_P(EventsGlTest, ShadersCanReadTheList) {
    make({.capacity = 5000});
    ASSERT_TRUE(setEvents(*particles_, EventOptions{.lasting = true, .max_per_step = 2000}));
    const Played run = played(*particles_, 60, 40, OnCollision::kBounce, false);
    const StepEvents events = takeEvents();
    ASSERT_GT(events.events.size(), 20U);
    const EventList* list = eventList(*particles_);
    ASSERT_NE(list, nullptr);
    EXPECT_EQ(required(readTextureFloats(list->total(), 1, 1)).front(),
              static_cast<float>(events.events.size()));
    std::vector<std::vector<float>> planes;
    for (const GlTexture& texture : list->textures()) {
        planes.push_back(required(readTextureFloats(texture, kEventsWidth, 1)));
    }
    for (std::size_t i = 0; i < events.events.size(); ++i) {
        const ParticleEvent& event = events.events[i];
        const auto texel = [&](std::size_t plane) {
            const float* at = &planes[plane][4 * i];
            return glm::vec4(at[0], at[1], at[2], at[3]);
        };
        EXPECT_EQ(glm::vec3(texel(0)), event.position);
        EXPECT_EQ(texel(1), glm::vec4(event.normal, event.speed));
        EXPECT_EQ(texel(2), glm::vec4(event.velocity, event.body));
        EXPECT_EQ(glm::vec3(texel(3)), glm::vec3(event.index, event.id, event.type));
    }
}

RELIEF_INSTANTIATE_STEP_TESTS(EventsGlTest);

}  // namespace
}  // namespace relief
