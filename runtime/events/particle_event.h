// SPDX-License-Identifier: Apache-2.0
// Particle events in a step: hits and deaths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

namespace relief {

/// Selects the events that a particle system lists.
struct EventOptions {
    bool hits = true;  ///< hits of particles without contact in the previous step
    /// Hits of particles with contact in the previous step. Particles that rest, slide or roll hit in most steps.
    bool lasting = false;
    bool deaths = false;     ///< deaths by age and by collision (OnCollision::kDie)
    float min_speed = 0.0F;  ///< ignores slower hits; world units/s, ≥ 0
    /// 1…ParticleSystem::kCapacityMax. Further events, those with the highest indices, are dropped.
    std::uint32_t max_per_step = 65'536;
    std::optional<std::uint32_t> type{};  ///< only this particle type
    std::optional<int> material{};        ///< only hits on this material, see ParticleEvent::material
    friend bool operator==(const EventOptions&, const EventOptions&) = default;
};

/// A hit, a death, or both (a hit that kills). A particle has at most one event in a step.
struct ParticleEvent {
    std::uint32_t id = 0;     ///< see ParticleState::id
    std::uint32_t index = 0;  ///< index of the particle's texel
    std::uint32_t type = 0;
    double time = 0.0;  ///< seconds, as in ParticleSystem::time()
    /// Contact point or place of death; world space. The surface is assumed flat within the step.
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};  ///< before the hit, including the forces of the step; world units/s
    bool hit = false;
    bool lasts = false;  ///< a hit by a particle that also had contact in the previous step
    bool death = false;
    // Hits only:
    glm::vec3 normal{0.0F};  ///< outwards from the body, unit length
    float speed = 0.0F;      ///< approach speed along the normal, relative to the surface, ≥ 0
    int body = -1;           ///< −1: the floor
    int material = -1;       ///< at the contact: an index into WorldTextures::materialNames(); −1: none
};

/// The events of one step: one list after the other, each in ascending order of index.
struct StepEvents {
    std::uint64_t tag = 0;      ///< passed to requestEvents()
    double time = 0.0;          ///< the end of the step, seconds
    std::uint32_t dropped = 0;  ///< events beyond EventOptions::max_per_step
    std::vector<ParticleEvent> events;
    struct List {
        std::size_t size = 0;  ///< number of events in the list
        std::uint32_t dropped = 0;
    };
    std::vector<List> lists{};  ///< one for each EventOptions

    /// Returns the events of a list.
    [[nodiscard]] std::span<const ParticleEvent> of(std::size_t list) const {
        std::size_t first = 0;
        for (std::size_t i = 0; i < list; ++i) {
            first += lists[i].size;
        }
        return std::span(events).subspan(first, lists[list].size);
    }
};

}  // namespace relief
