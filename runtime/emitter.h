// Where particles come from: a box that gives birth at a steady rate, on the CPU. The same settings and seed
// give the same births, bit for bit, on every machine: sampling uses integers, + and × alone.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <vector>

namespace relief {

/// PCG32 (O'Neill 2014, pcg32_random_r): 2^64 states, 2^63 streams.
class Pcg32 {
  public:
    explicit Pcg32(std::uint64_t seed, std::uint64_t stream = 0);
    std::uint32_t next();
    /// Uniform in [0, 1): a multiple of 2^-24.
    float uniform();
    /// Uniform between two numbers, both possible.
    float between(float low, float high);

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_ = 1;
};

/// One particle to be born.
struct Birth {
    glm::vec3 position{0.0F};  ///< object units
    glm::vec3 velocity{0.0F};  ///< object units a second
    float lifetime = 1.0F;     ///< seconds, > 0
    std::uint32_t type = 0;    ///< carried along for the renderer, below 2^24
};

struct EmitterSettings {
    glm::vec3 box_min{0.0F};  ///< births are uniform in this box; a point where box_min = box_max
    glm::vec3 box_max{0.0F};
    double rate = 0.0;  ///< births a second, ≥ 0
    double duration =
        std::numeric_limits<double>::infinity();  ///< seconds after which no more births come, > 0
    std::uint64_t burst = 0;                      ///< births at the very start, on top of the rate
    glm::vec3 velocity{0.0F};                     ///< mean velocity at birth
    glm::vec3 velocity_spread{0.0F};  ///< each component is uniform in velocity ± velocity_spread
    float lifetime_min = 1.0F;        ///< seconds; lifetimes are uniform between the two
    float lifetime_max = 1.0F;
    std::uint32_t type = 0;
};

class Emitter {
  public:
    Emitter(const EmitterSettings& settings, std::uint64_t seed);

    /// The births of the next `dt` seconds: after time t, burst + ⌊rate · min(t, duration)⌋ births have been
    /// asked for in all, however t was cut into steps. \param room    at most so many are made: what the
    /// particle system has place for. \param births  they are added at its end. \return how many were asked
    /// for but found no room; they are not made up for later.
    std::uint64_t emit(double dt, std::uint64_t room, std::vector<Birth>& births);

    [[nodiscard]] const EmitterSettings& settings() const { return settings_; }

  private:
    EmitterSettings settings_;
    Pcg32 random_;
    double elapsed_ = 0.0;         // seconds
    std::uint64_t asked_for_ = 0;  // births so far, those without room included
};

}  // namespace relief
