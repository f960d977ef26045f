// SPDX-License-Identifier: Apache-2.0
// Generates births of particles on the CPU: positions, velocities and times. The same settings and seed give
// bit-identical births on every machine (runtime/particles/random.h). Births do not depend on the step length, except
// for ages, for places and velocities on moving surfaces, and after emit() has dropped births.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/enum_words.h"
#include "formats/base/result.h"
#include "runtime/particles/birth.h"
#include "runtime/particles/birth_surface.h"
#include "runtime/particles/random.h"

namespace relief {

/// Emitting shapes. Births are uniform over the volume, the area or the list of points.
enum class EmitterShape : std::uint8_t {
    kBox,     ///< box_min … box_max
    kSphere,  ///< the ball around center
    kShell,   ///< the surface of that ball
    kDisc,    ///< around center, perpendicular to normal
    kPoints,  ///< a list of points, for example on a mesh's surface
    kPoint,   ///< box_min, which equals box_max
    kSurface  ///< a triangle surface, which may move and deform
};
template <>
inline constexpr std::array<std::string_view, 7> kWordsOf<EmitterShape>{"box",    "sphere", "shell",  "disc",
                                                                        "points", "point",  "surface"};

/// An additional speed along a direction: the sum of a uniform and a normally distributed term, redrawn if negative.
struct EmitterAim {
    /// Axis of the cone, nonzero; required for kBox, kPoint, and points without normals. nullopt: the normal at the
    /// emitting point: outwards for kSphere and kShell, EmitterSettings::normal for kDisc, PointList::normals for
    /// kPoints, the triangle's normal for kSurface.
    std::optional<glm::vec3> direction;
    float cone_degrees = 0.0F;  ///< half angle, 0…180; uniform over the solid angle
    float speed_min = 0.0F;     ///< object units/s, ≥ 0; uniform between both limits
    float speed_max = 0.0F;
    float speed_deviation = 0.0F;  ///< standard deviation of the normally distributed term, ≥ 0; mean 0
};

/// Emitting points.
struct PointList {
    std::vector<glm::vec3> positions;  ///< object units, each coordinate within ±kPointCoordinateMax
    std::vector<glm::vec3> normals;    ///< unit length; one for each position, or empty
};
inline constexpr std::size_t kPointsMax = std::size_t{1} << 22;
inline constexpr double kPointCoordinateMax = 1e9;

struct EmitterSettings {
    EmitterShape shape = EmitterShape::kBox;
    glm::vec3 box_min{0.0F};
    glm::vec3 box_max{0.0F};
    glm::vec3 center{0.0F};
    float radius = 0.0F;                 ///< sphere, shell and disc, ≥ 0
    glm::vec3 normal{0.0F, 1.0F, 0.0F};  ///< disc, nonzero
    PointList points;                    ///< kPoints: at least one
    BirthSurfaceValue surface;           ///< kSurface: in its initial position, with a nonzero area

    double start = 0.0;  ///< delay before the first birth, seconds, ≥ 0
    double rate = 0.0;   ///< births per second, ≥ 0
    /// Emission time after the start, seconds, > 0.
    double duration = std::numeric_limits<double>::infinity();
    std::uint64_t burst = 0;   ///< additional births at the start
    double burst_every = 0.0;  ///< seconds between bursts, ≥ 0; 0: one burst, at the start

    glm::vec3 velocity{0.0F};         ///< common to all births
    glm::vec3 velocity_spread{0.0F};  ///< added, each component uniform in ± velocity_spread
    std::optional<EmitterAim> aim;    ///< added
    float lifetime_min = 1.0F;        ///< seconds; lifetimes are uniform between both limits
    float lifetime_max = 1.0F;
    std::uint32_t type = 0;
    /// True: birth n of `rate` occurs at start + n / rate and gets an age, so that it moves for the rest of its step.
    /// False: all births of a step occur at its beginning.
    bool interpolate = true;
};

class Emitter {
  public:
    /// Validates settings. Errors: kUsage, naming the member.
    [[nodiscard]] static Result<void> check(const EmitterSettings& settings);

    /// \param settings  must pass check().
    /// \param stream    emitters with the same seed and different streams are independent.
    Emitter(EmitterSettings settings, std::uint64_t seed, std::uint64_t stream = 0);

    /// Generates the births of the next `dt` seconds in time order; at equal times, births of `rate` precede a burst.
    /// After time t, with s = min(t − start, duration), a total of burst (1 + ⌊s / burst_every⌋) + ⌊rate · s⌋ births
    /// are due, independent of the step lengths; a burst at the end of the duration is omitted. The n-th birth does not
    /// depend on the step lengths either, except for its age and, on a moving surface, its place and velocity.
    /// \param room    maximum number of births to generate: the free capacity of the particle system.
    /// \param births  the new births are appended to this vector.
    /// \return the number of due births that exceed `room`; they are dropped.
    std::uint64_t emit(double dt, std::uint64_t room, std::vector<Birth>& births);
    /// Returns whether births are due in the next `dt` seconds.
    [[nodiscard]] bool isDue(double dt) const;

    /// Moves the surface of kSurface for the next emit(), see BirthSurface::move(). While its area is 0, emit() drops
    /// all births.
    void moveSurface(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) {
        if (settings_.surface) {
            settings_.surface->move(before, now, seconds);
        }
    }
    /// Returns the surface velocity at each birth of the last emit(), for carry(); empty for all shapes except
    /// kSurface.
    [[nodiscard]] std::span<const glm::vec3> birthSurfaceVelocities() const {
        return birth_surface_velocities_;
    }

    [[nodiscard]] const EmitterSettings& settings() const { return settings_; }

  private:
    [[nodiscard]] double rateBirths(double active) const;
    [[nodiscard]] std::uint64_t burstsDue(double active) const;
    /// Totals due up to a time since the start.
    struct Due {
        double elapsed = 0.0;
        double remainder = 0.0;
        bool started = false;
        std::uint64_t steady = 0;
        std::uint64_t bursts = 0;
    };
    [[nodiscard]] Due dueAfter(double dt) const;
    void sample(Birth& birth);
    [[nodiscard]] glm::vec3 place(Birth& birth);
    [[nodiscard]] glm::vec3 aimed(const glm::vec3& normal);

    EmitterSettings settings_;
    Pcg32 random_;
    Basis basis_;             // around the disc's normal
    Basis aim_basis_;         // around the aim's direction
    float opening_ = 0.0F;    // oneMinusCosine() of the cone
    double elapsed_ = 0.0;    // seconds
    double remainder_ = 0.0;  // rounding error of elapsed_
    // Births of `rate` and number of bursts due so far, including dropped births.
    std::uint64_t steady_ = 0;
    std::uint64_t bursts_ = 0;
    std::vector<glm::vec3> birth_surface_velocities_;
};

}  // namespace relief
