// SPDX-License-Identifier: Apache-2.0
#include "runtime/events/spawner.h"

#include <algorithm>

namespace relief {

Spawner::Spawner(const SpawnSettings& settings, std::uint64_t seed, std::uint64_t stream)
    : settings_(settings),
      random_(seed, stream),
      opening_(static_cast<float>(oneMinusCosine(static_cast<double>(settings.cone_degrees)))) {}

bool Spawner::matches(const ParticleEvent& event) const {
    if (settings_.parent && event.type != *settings_.parent) {
        return false;
    }
    return settings_.on == SpawnOn::kDeath
               ? event.death
               : event.hit && !event.lasts && event.speed >= settings_.min_speed &&
                     settings_.material.value_or(event.material) == event.material;
}

EventOptions Spawner::eventOptions() const {
    const bool hits = settings_.on == SpawnOn::kCollision;
    return {.hits = hits,
            .deaths = !hits,
            .min_speed = hits ? settings_.min_speed : 0.0F,
            .max_per_step = settings_.max_per_step,
            .type = settings_.parent,
            .material = hits ? settings_.material : std::nullopt};
}

std::uint64_t Spawner::spawn(std::span<const ParticleEvent> events, std::span<const ParticleType> types,
                             std::uint64_t room, std::vector<Birth>& births) {
    const float radius =
        types.empty() ? 0.0F : types[std::min<std::size_t>(settings_.type, types.size() - 1)].radius;
    std::uint64_t left = std::min<std::uint64_t>(room, settings_.max_per_step);
    std::uint64_t rejected = 0;
    std::uint64_t used = 0;
    for (const ParticleEvent& event : events) {
        if (!matches(event)) {
            continue;
        }
        // No random numbers are drawn beyond `max_per_step`, so a shorter event list gives the same births.
        if (++used > settings_.max_per_step) {
            rejected += settings_.count_min;
            continue;
        }
        const std::uint64_t due =
            settings_.count_min + random_.below(settings_.count_max - settings_.count_min + 1);
        const std::uint64_t made = std::min(due, left);
        for (std::uint64_t i = 0; i < made; ++i) {
            const Birth birth = sample(event, radius);
            if (isValid(birth)) {
                births.push_back(birth);
            } else {
                ++rejected;
            }
        }
        left -= made;
        rejected += due - made;
    }
    return rejected;
}

// The order of the random draws must not change, because seeded runs depend on it: direction, speed, lifetime.
Birth Spawner::sample(const ParticleEvent& event, float radius) {
    glm::vec3 axis = event.hit ? event.normal : unitVector(event.velocity);
    if (axis == glm::vec3(0.0F)) {
        axis = {0.0F, 1.0F, 0.0F};
    }
    const glm::vec3 direction = basisAbout(axis).toWorld(inCone(random_, opening_));
    const float speed =
        random_.between(settings_.speed_min, settings_.speed_max) + settings_.kick * event.speed;
    // The velocity without its component towards the surface.
    const glm::vec3 along = event.velocity + event.speed * event.normal;
    Birth birth;
    birth.position = event.position + radius * event.normal;
    birth.velocity = settings_.inherit * along + speed * direction;
    birth.lifetime = random_.between(settings_.lifetime_min, settings_.lifetime_max);
    birth.type = settings_.type;
    return birth;
}

}  // namespace relief
