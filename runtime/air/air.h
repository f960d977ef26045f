// SPDX-License-Identifier: Apache-2.0
// Forces on particles besides collision and gravity: moving air, which acts through drag, and force fields, which add
// an acceleration. These are plain settings; air_block.h uploads them and shaders/air/air.glsl evaluates them.
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

/// Pulls all particles towards a point. `strength` is the maximum acceleration, reached at distance `radius`. Inside
/// the radius it decreases linearly to 0 at the point; outside it decreases as (radius / distance)^falloff. Falloff 2
/// is the gravity of a ball of uniform density.
struct Attractor {
    glm::vec3 position{0.0F};                         ///< object units
    float strength = 0.0F;                            ///< object units/s²; negative: repels
    float radius = 1.0F;                              ///< object units, > 0
    int falloff = 2;                                  ///< 0, 1 or 2
    float reach = std::numeric_limits<float>::max();  ///< object units, > 0; no effect beyond
    friend bool operator==(const Attractor&, const Attractor&) = default;
};

void fields(FieldVisitor& visit, Attractor& a);

/// Accelerates particles around a straight line, right-handed about `axis`, with no radial or axial component. The
/// magnitude follows the formula of Attractor, with distances from the line.
struct Vortex {
    glm::vec3 center{0.0F};            ///< a point on the line, object units
    glm::vec3 axis{0.0F, 1.0F, 0.0F};  ///< direction of the line, nonzero, any length
    float strength = 0.0F;             ///< object units/s²; negative: opposite rotation
    float radius = 1.0F;               ///< object units, > 0
    int falloff = 1;                   ///< 0, 1 or 2
    friend bool operator==(const Vortex&, const Vortex&) = default;
};

void fields(FieldVisitor& visit, Vortex& v);

/// Raises tiny radii so that strength / radius does not overflow a float.
template <class Field>
requires std::same_as<Field, Attractor> || std::same_as<Field, Vortex> std::optional<FieldFault> check(
    Field& field, const GivenFields& /*given*/) {
    field.radius = field.radius > 1e-30F ? field.radius : 1e-30F;
    return std::nullopt;
}

struct AirSettings {
    static constexpr std::size_t kAttractorsMax = kAirFieldsMax;
    static constexpr std::size_t kVorticesMax = kAirFieldsMax;

    glm::vec3 wind{0.0F};                   ///< object units/s, uniform
    std::shared_ptr<const FlowField> flow;  ///< may be null; shared because it may be large
    std::optional<CurlNoise> curl_noise;
    std::vector<Attractor> attractors;  ///< at most kAttractorsMax
    std::vector<Vortex> vortices;       ///< at most kVorticesMax
    /// Dynamic viscosity, object mass units / (object length units · s), ≥ 0. Enables drag by Stokes' law, which
    /// depends on a particle's size and mass. If unset, the drag rate is Forces::drag / mass.
    std::optional<float> viscosity;
    friend bool operator==(const AirSettings&, const AirSettings&) = default;
};

/// Visits the attractor, vortex and curl_noise tables of a scene.
void fields(FieldVisitor& visit, AirSettings& air);

/// Checks all settings. Errors: those of checkFlow; kUsage (a number out of range, too many forces).
[[nodiscard]] Result<void> checkAir(const AirSettings& air);

/// Converts seconds since the start, such as ParticleSystem::time(), into the shader's u_air_time. Do not use the GPU
/// clock of a particle system, which is set back periodically.
[[nodiscard]] float airTime(const AirSettings& air, double seconds);

}  // namespace relief
