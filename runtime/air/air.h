// SPDX-License-Identifier: Apache-2.0
// Forces on a particle besides collision and gravity: moving air, which acts through drag, and fields,
// which accelerate. Plain settings; shaders/air/air.glsl computes with them, and air_block.h brings them there.
#pragma once

#include <glm/vec3.hpp>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "formats/base/result.h"
#include "runtime/air/curl_noise.h"
#include "runtime/air/flow_field.h"
#include "shaders/air/constants.h"

namespace relief {

/// Pulls towards a point, all particles alike. `strength` is the acceleration at distance `radius`, its
/// greatest: inside it falls off linearly to 0 at the point, outside as (radius / distance)^falloff. With
/// falloff 2 it is the gravity of a ball of even density.
struct Attractor {
    glm::vec3 position{0.0F};                         ///< object units
    float strength = 0.0F;                            ///< object units a second squared; below 0 it repels
    float radius = 1.0F;                              ///< object units, > 0
    int falloff = 2;                                  ///< 0, 1 or 2
    float reach = std::numeric_limits<float>::max();  ///< object units, > 0; nothing beyond
    friend bool operator==(const Attractor&, const Attractor&) = default;
};

void fields(FieldVisitor& visit, Attractor& a);

/// Drives round a straight line, right-handed about `axis`; along and across it, it does nothing. The
/// strength goes with the distance from the line as an attractor's does with that from the point.
struct Vortex {
    glm::vec3 center{0.0F};            ///< a point on the line, object units
    glm::vec3 axis{0.0F, 1.0F, 0.0F};  ///< the line's direction, of any length but 0
    float strength = 0.0F;             ///< object units a second squared; below 0 it turns the other way
    float radius = 1.0F;               ///< object units, > 0
    int falloff = 1;                   ///< 0, 1 or 2
    friend bool operator==(const Vortex&, const Vortex&) = default;
};

void fields(FieldVisitor& visit, Vortex& v);

/// The greatest strength over the radius stays a float.
template <class Field>
requires std::same_as<Field, Attractor> || std::same_as<Field, Vortex> std::optional<FieldFault> check(
    Field& field, const GivenFields& /*given*/) {
    field.radius = field.radius > 1e-30F ? field.radius : 1e-30F;
    return std::nullopt;
}

struct AirSettings {
    static constexpr std::size_t kAttractorsMax = kAirFieldsMax;
    static constexpr std::size_t kVorticesMax = kAirFieldsMax;

    glm::vec3 wind{0.0F};                   ///< object units a second, everywhere
    std::shared_ptr<const FlowField> flow;  ///< may be null; shared, for it may be large
    std::optional<CurlNoise> curl_noise;
    std::vector<Attractor> attractors;  ///< kAttractorsMax at most
    std::vector<Vortex> vortices;       ///< kVorticesMax at most
    /// Dynamic viscosity, object mass units / (object length units · s), ≥ 0: drag by Stokes' law, other for
    /// every size and mass of particle. Without it drag is one rate for all.
    std::optional<float> viscosity;
    friend bool operator==(const AirSettings&, const AirSettings&) = default;
};

/// The tables of a scene that describe forces; wind and viscosity are in its [forces].
void fields(FieldVisitor& visit, AirSettings& air);

/// Fails as checkFlow does, and with kUsage (a number out of the range given above, too many).
[[nodiscard]] Result<void> checkAir(const AirSettings& air);

/// The time to hand to the shader, from seconds since the start. Count them
/// in a double, and not by a particle system's own clock, which is set back now and then.
[[nodiscard]] float airTime(const AirSettings& air, double seconds);

}  // namespace relief
