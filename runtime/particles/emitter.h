// SPDX-License-Identifier: Apache-2.0
// Births of particles: places, velocities and moments of birth, on the CPU. The same settings and seed
// give the same births, bit for bit, on every machine (runtime/particles/random.h), however time is cut into
// steps.
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

/// Places of birth. All are uniform: in volume, over the area, or among the points.
enum class EmitterShape : std::uint8_t {
    kBox,     ///< box_min … box_max; a point where the two are equal
    kSphere,  ///< the ball round center
    kShell,   ///< the surface of that ball
    kDisc,    ///< round center, at right angles to normal
    kPoints,  ///< the points of a list: of a mesh's surface, say
    kPoint,   ///< box_min, to which box_max is equal
    kSurface  ///< a surface of triangles, which may move and bend
};
template <>
inline constexpr std::array<std::string_view, 7> kWordsOf<EmitterShape>{"box",    "sphere", "shell",  "disc",
                                                                        "points", "point",  "surface"};

/// A speed along a direction. It adds a uniform and a normal share, and where the sum is below 0 draws anew.
struct EmitterAim {
    /// The middle of the cone, not 0. nullopt: the normal of the place of birth: outwards for sphere and
    /// shell, `normal` for a disc, the point's own for points, its triangle's for a surface; a box has none.
    std::optional<glm::vec3> direction;
    float cone_degrees = 0.0F;  ///< half angle, 0…180; uniform over its solid angle
    float speed_min = 0.0F;     ///< object units a second, ≥ 0; uniform between the two
    float speed_max = 0.0F;
    float speed_deviation = 0.0F;  ///< ≥ 0, of the normal share, whose mean is 0
};

/// Places of birth.
struct PointList {
    std::vector<glm::vec3> positions;  ///< object units, each coordinate within ±kPointCoordinateMax
    std::vector<glm::vec3> normals;    ///< of length 1; as many as positions, or none
};
inline constexpr std::size_t kPointsMax = std::size_t{1} << 22;
inline constexpr double kPointCoordinateMax = 1e9;

struct EmitterSettings {
    EmitterShape shape = EmitterShape::kBox;
    glm::vec3 box_min{0.0F};
    glm::vec3 box_max{0.0F};
    glm::vec3 center{0.0F};
    float radius = 0.0F;                 ///< of sphere, shell and disc, ≥ 0
    glm::vec3 normal{0.0F, 1.0F, 0.0F};  ///< of the disc, not 0
    PointList points;                    ///< at least one for kPoints
    BirthSurfaceValue surface;           ///< of some area for kSurface; where it is at first

    double start = 0.0;  ///< seconds before anything is born, ≥ 0
    double rate = 0.0;   ///< births a second, ≥ 0
    /// Seconds from the start until no more births come, > 0.
    double duration = std::numeric_limits<double>::infinity();
    std::uint64_t burst = 0;   ///< births at the very start, on top of the rate
    double burst_every = 0.0;  ///< seconds from burst to burst, ≥ 0; 0: only the one at the start

    glm::vec3 velocity{0.0F};         ///< of every birth
    glm::vec3 velocity_spread{0.0F};  ///< on top of it, each component uniform in ± velocity_spread
    std::optional<EmitterAim> aim;    ///< and on top of both
    float lifetime_min = 1.0F;        ///< seconds; lifetimes are uniform between the two
    float lifetime_max = 1.0F;
    std::uint32_t type = 0;
    /// Births by rate get an age: the moment of birth n is start + n / rate, and by the end of its step it
    /// has lived the rest of that step. False: all births of a step start at its beginning, from where they
    /// are.
    bool spread = true;
};

class Emitter {
  public:
    /// Refuses settings with which the constructor would have to guess.
    /// Errors: kUsage, naming the member.
    [[nodiscard]] static Result<void> check(const EmitterSettings& settings);

    /// \param settings  that check() finds nothing wrong with.
    /// \param stream    emitters of one seed and different streams are independent.
    Emitter(EmitterSettings settings, std::uint64_t seed, std::uint64_t stream = 0);

    /// The births of the next `dt` seconds, in the order of time, births by rate before a burst of the same
    /// moment: after time t, with s = min(t − start, duration), burst (1 + ⌊s / burst_every⌋) + ⌊rate · s⌋
    /// births are due in all, however t was cut into steps (a burst at the end of the duration is
    /// not). The n-th birth that is made is the same but for its age, too.
    /// \param room    at most so many are made: what the particle system has place for.
    /// \param births  they are added at its end.
    /// \return how many were due but found no room; they are not made up for later.
    std::uint64_t emit(double dt, std::uint64_t room, std::vector<Birth>& births);
    /// Anything is due in the next `dt` seconds.
    [[nodiscard]] bool isDue(double dt) const;

    /// Moves the surface of kSurface for the next emit(): BirthSurface::move(). While it has no area, births that are due find no
    /// room.
    void moveSurface(std::span<const glm::vec3> before, std::span<const glm::vec3> now, double seconds) {
        if (settings_.surface) {
            settings_.surface->move(before, now, seconds);
        }
    }
    /// The velocities of the places of the births that the last emit() made, for carry(): of kSurface as many, else none.
    [[nodiscard]] std::span<const glm::vec3> placeVelocities() const { return place_velocities_; }

    [[nodiscard]] const EmitterSettings& settings() const { return settings_; }

  private:
    [[nodiscard]] double steadyBirths(double active) const;
    [[nodiscard]] std::uint64_t burstsDue(double active) const;
    /// All that is due by a time, since the beginning.
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
    Basis basis_;             // about the disc's normal
    Basis aim_basis_;         // about the aim's direction
    float opening_ = 0.0F;    // oneMinusCosine of the cone
    double elapsed_ = 0.0;    // seconds
    double remainder_ = 0.0;  // what rounding took off elapsed_
    // Asked for so far, those without room included.
    std::uint64_t steady_ = 0;
    std::uint64_t bursts_ = 0;
    std::vector<glm::vec3> place_velocities_;
};

}  // namespace relief
