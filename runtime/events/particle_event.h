// SPDX-License-Identifier: Apache-2.0
// Events of particles in a step: hits and deaths.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <vector>

namespace relief {

/// Which events a particle system lists.
struct EventOptions {
    bool hits = true;        ///< hits where the step before touched nothing
    bool lasting = false;    ///< hits where it did: what rests, slides or rolls hits in most steps
    bool deaths = false;     ///< of age, and of collisions (OnCollision::kDie)
    float min_speed = 0.0F;  ///< slower hits are left out; world units a second, ≥ 0
    std::uint32_t most =
        65'536;  ///< of a step, 1…kCapacityMax; the rest, of the highest indices, is left out
    std::optional<std::uint32_t> type{};  ///< events of others are left out
    std::optional<int> material{};        ///< as ParticleEvent::material: hits on others are left out
    friend bool operator==(const EventOptions&, const EventOptions&) = default;
};

/// One hit or death. A step has at most one of a particle, which may be both: a hit that kills.
struct ParticleEvent {
    std::uint32_t id = 0;     ///< as ParticleState::id
    std::uint32_t index = 0;  ///< its texel
    std::uint32_t type = 0;
    double time = 0.0;  ///< seconds since the beginning, as ParticleSystem::time()
    /// The contact with the surface, or the place of death; world space. The surface counts as flat within the step.
    glm::vec3 position{0.0F};
    glm::vec3 velocity{0.0F};  ///< that it came with, the forces of the step in it; world units a second
    bool hit = false;
    bool lasts = false;  ///< a hit, and the step before touched something, too
    bool death = false;
    // Of a hit:
    glm::vec3 normal{0.0F};  ///< out of the body, of length 1
    float speed = 0.0F;      ///< of approach along the normal, relative to the surface, ≥ 0
    int body = -1;           ///< −1: the floor
    int material = -1;       ///< of it there: a number of WorldTextures::materialNames(); −1: none
};

/// The events of one step, in ascending order of index. Of several lists those of the first come first.
struct StepEvents {
    std::uint64_t tag = 0;      ///< as requested
    double time = 0.0;          ///< the end of the step, seconds
    std::uint32_t dropped = 0;  ///< events beyond EventOptions::most
    std::vector<ParticleEvent> events;
    struct List {
        std::size_t size = 0;  ///< of `events`
        std::uint32_t dropped = 0;
    };
    std::vector<List> lists{};  ///< as many as there are EventOptions

    /// The events of a list.
    [[nodiscard]] std::span<const ParticleEvent> of(std::size_t list) const {
        std::size_t first = 0;
        for (std::size_t i = 0; i < list; ++i) {
            first += lists[i].size;
        }
        return std::span(events).subspan(first, lists[list].size);
    }
};

}  // namespace relief
