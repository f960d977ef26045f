// Sums over all particles on the GPU: passes that each sum 4 × 4 texels into one, down to a single texel, which is copied into a
// buffer. Nothing waits for the GPU but wait(): a sample is asked for after a step and collected some steps later.
//
//     bytes on the GPU < 32/15 · texels of the state + 1 kB (for the system's capacity)
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "formats/base/result.h"
#include "runtime/gl/gl_object.h"
#include "runtime/gl/readbacks.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// Sums over the live particles, without those born since the last step.
struct StatisticsSample {
    std::uint64_t tag = 0;         ///< as given to request()
    std::uint32_t alive = 0;       ///< as the GPU counts them
    std::uint32_t in_contact = 0;  ///< that touched something in the last step, caught ones included
    std::uint32_t caught = 0;      ///< that the last step found inside and turned out
    std::uint64_t collisions = 0;  ///< steps in contact so far; exact up to 2^36, then to 24 bits
    double energy = 0.0;           ///< kinetic, per unit of mass: ½ Σ |v|², to a relative 3e-6
    float max_speed = 0.0F;        ///< object units a second
    /// The first type of which a live particle is lost: its position or velocity is no number, infinite, or faster than
    /// kSpeedMaxOfState. As Birth::type. Lost ones count as alive, and in no other sum.
    std::optional<std::uint32_t> lost_type{};
};

class Statistics {
  public:
    static constexpr int kInFlightMax = 16;  ///< requests not yet collected

    /// For systems of this capacity. Needs a current context, as every call does.
    /// Errors: kUsage (0 or above ParticleSystem::kCapacityMax), kLimit, kUnsupported, kFailure.
    [[nodiscard]] static Result<Statistics> create(std::uint32_t capacity);

    /// Requests a sample of the particles as they are now; restores the GL state.
    /// \param tag  comes back with it, the number of the step for example.
    /// \return false, and nothing is requested, while kInFlightMax samples are under way, or if the system is
    ///         larger than the capacity.
    bool request(const ParticleSystem& particles, std::uint64_t tag);

    /// The oldest sample, if the GPU has finished it: never waits.
    [[nodiscard]] std::optional<StatisticsSample> poll();
    /// The oldest sample, which the GPU is waited for; nullopt if none is under way.
    /// Errors: kFailure (the GPU has not answered for ten seconds, or its memory cannot be read).
    [[nodiscard]] Result<std::optional<StatisticsSample>> wait();

    [[nodiscard]] int inFlight() const { return readbacks_.inFlight(); }

  private:
    struct Level {
        GlTexture counts;
        GlTexture sums;
        GlFramebuffer target;
    };

    Statistics() = default;
    [[nodiscard]] Result<void> createPrograms();
    [[nodiscard]] Result<void> createLevels();
    void sum(std::uint32_t width, std::uint32_t height) const;

    std::uint32_t capacity_ = 0;
    Readbacks<std::uint64_t, kInFlightMax> readbacks_;
    std::vector<Level> levels_;
    GlProgram state_program_;  // the first pass
    GlProgram sum_program_;    // further passes
};

}  // namespace relief
