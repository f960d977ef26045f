// SPDX-License-Identifier: Apache-2.0
// Spawns particles where others hit or die: splashes, debris, sparks. Runs on the CPU and reads the event lists of a
// particle system. The same events, settings and seed give bit-identical births on every machine.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/events/particle_event.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_type.h"
#include "runtime/particles/random.h"

namespace relief {

enum class SpawnOn : std::uint8_t {
    kCollision,  ///< a hit of a particle without contact in the previous step
    kDeath,      ///< a death by age or by a hit
};

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<SpawnOn>{"collision", "death"};

struct SpawnSettings {
    SpawnOn on = SpawnOn::kCollision;
    std::optional<std::uint32_t> parent;  ///< type of the particle that hits or dies; nullopt: all
    float min_speed = 0.0F;               ///< ignores slower hits; ≥ 0; for kCollision
    std::optional<int> material;  ///< only hits on this material, see ParticleEvent::material; for kCollision

    std::uint32_t type = 0;  ///< type of the births
    /// Births per event, uniform in [count_min, count_max].
    std::uint32_t count_min = 1;
    std::uint32_t count_max = 1;
    std::uint32_t max_per_step = 10'000;  ///< births, ≥ 1; further births are rejected
    float lifetime_min = 1.0F;            ///< seconds, > 0; uniform between both limits
    float lifetime_max = 1.0F;

    /// Fraction of the parent's velocity that births inherit, ≥ 0. For hits, the approach speed along the normal is
    /// first removed from this velocity.
    float inherit = 0.0F;
    /// Additional speed: uniform in [speed_min, speed_max], plus `kick` times ParticleEvent::speed; world units/s, ≥ 0.
    /// Its direction lies in a cone around the normal of a hit, or around the velocity of a particle that dies of old
    /// age (upwards if the particle is at rest).
    float speed_min = 0.0F;
    float speed_max = 0.0F;
    float kick = 0.0F;
    float cone_degrees = 180.0F;  ///< half angle, 0…180; uniform over the solid angle

    friend bool operator==(const SpawnSettings&, const SpawnSettings&) = default;
};

class Spawner {
  public:
    /// \param settings  finite, within the ranges of the members, with ordered limits.
    /// \param stream    spawners with the same seed and different streams are independent.
    Spawner(const SpawnSettings& settings, std::uint64_t seed, std::uint64_t stream = 0);

    /// Generates the births of a step's events, in order, with age 0. Births of hits touch the surface from outside.
    /// Only the first `max_per_step` matching events are used; each later event counts as `count_min` rejected births.
    /// \param types   of the particle system, for their radii.
    /// \param room    maximum number of births to generate.
    /// \param births  the births are appended to it.
    /// \return the number of births rejected because of `room` or `max_per_step`, or because the event has no finite
    /// position or velocity.
    std::uint64_t spawn(std::span<const ParticleEvent> events, std::span<const ParticleType> types,
                        std::uint64_t room, std::vector<Birth>& births);
    std::uint64_t spawn(const StepEvents& step, std::span<const ParticleType> types, std::uint64_t room,
                        std::vector<Birth>& births) {
        return spawn(step.events, types, room, births);
    }

    /// Returns options that select exactly the matching events, up to the number that a step can use.
    [[nodiscard]] EventOptions eventOptions() const;

    [[nodiscard]] const SpawnSettings& settings() const { return settings_; }

  private:
    [[nodiscard]] bool matches(const ParticleEvent& event) const;
    [[nodiscard]] Birth sample(const ParticleEvent& event, float radius);

    SpawnSettings settings_;
    Pcg32 random_;
    float opening_ = 0.0F;  // oneMinusCosine() of the cone
};

}  // namespace relief
