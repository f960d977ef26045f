// SPDX-License-Identifier: Apache-2.0
// Births where particles hit or die: splashes, debris, sparks. On the CPU, from the events that a particle system lists;
// the same events, settings and seed give the same births, bit for bit, on every machine.
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
    kCollision,  ///< a hit where the step before touched nothing
    kDeath,      ///< of age or of a hit
};

template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<SpawnOn>{"collision", "death"};

struct SpawnSettings {
    SpawnOn on = SpawnOn::kCollision;
    std::optional<std::uint32_t> of;  ///< the type of those that hit or die; nullopt: all
    float min_speed = 0.0F;           ///< slower hits make nothing; ≥ 0; for kCollision
    std::optional<int> material;  ///< as ParticleEvent::material: hits on others make nothing; for kCollision

    std::uint32_t type = 0;  ///< of what is born
    /// Births for each event, uniform between the two.
    std::uint32_t count_min = 1;
    std::uint32_t count_max = 1;
    std::uint32_t most = 10'000;  ///< births of a step, ≥ 1; the rest is refused
    float lifetime_min = 1.0F;    ///< seconds, > 0; uniform between the two
    float lifetime_max = 1.0F;

    /// Share of the parent's velocity, ≥ 0: of a hit that along the surface, which itself may move.
    float inherit = 0.0F;
    /// On top of it a speed about the normal of a hit, or about the velocity of a particle that dies of age (upwards where it stands):
    /// uniform between the two and `kick` times the speed of the hit; world units a second, ≥ 0.
    float speed_min = 0.0F;
    float speed_max = 0.0F;
    float kick = 0.0F;
    float cone_degrees = 180.0F;  ///< half angle, 0…180; uniform over its solid angle

    friend bool operator==(const SpawnSettings&, const SpawnSettings&) = default;
};

class Spawner {
  public:
    /// \param settings  finite, within the ranges of its members, spans in order.
    /// \param stream    spawners of one seed and different streams are independent.
    Spawner(const SpawnSettings& settings, std::uint64_t seed, std::uint64_t stream = 0);

    /// The births that the events of a step make, in their order, of age 0. Those behind the first `most` that it heeds change
    /// nothing but the number refused, where each counts as its least number of births. Where a hit makes them, they touch the
    /// surface from outside.
    /// \param types   of the particle system: their radii.
    /// \param room    at most so many are made.
    /// \param births  they are added at its end.
    /// \return how many were due but found no room, were above `most`, or have no finite place or velocity, because the
    /// event has none.
    std::uint64_t spawn(std::span<const ParticleEvent> events, std::span<const ParticleType> types,
                        std::uint64_t room, std::vector<Birth>& births);
    std::uint64_t spawn(const StepEvents& step, std::span<const ParticleType> types, std::uint64_t room,
                        std::vector<Birth>& births) {
        return spawn(step.events, types, room, births);
    }

    /// Exactly the events that it heeds, and as many of a step as it can use.
    [[nodiscard]] EventOptions eventOptions() const;

    [[nodiscard]] const SpawnSettings& settings() const { return settings_; }

  private:
    [[nodiscard]] bool heeds(const ParticleEvent& event) const;
    [[nodiscard]] Birth sample(const ParticleEvent& event, float radius);

    SpawnSettings settings_;
    Pcg32 random_;
    float opening_ = 0.0F;  // oneMinusCosine of the cone
};

}  // namespace relief
