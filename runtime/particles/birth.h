// SPDX-License-Identifier: Apache-2.0
// A particle to be born.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/base/finite.h"

namespace relief {

struct Birth {
    glm::vec3 position{0.0F};  ///< object units
    glm::vec3 velocity{0.0F};  ///< object units/s
    float lifetime = 1.0F;     ///< seconds, > 0
    std::uint32_t type = 0;    ///< see ParticleSystem::setTypes(); at most kBirthTypeMax
    /// Age at the start of the next step, in seconds, ≥ 0. The particle system advances the particle by this time, so
    /// that births of one step do not all start at the same point.
    float age = 0.0F;
};

/// A float represents every integer up to this one exactly.
inline constexpr std::uint32_t kBirthTypeMax = (1U << 24) - 1;

/// Returns whether a particle system accepts the birth: all numbers are finite and in the ranges above.
[[nodiscard]] inline bool isValid(const Birth& birth) {
    return isFinite(birth.position) && isFinite(birth.velocity) && birth.lifetime > 0.0F &&
           std::isfinite(birth.lifetime) && birth.age >= 0.0F && std::isfinite(birth.age) &&
           birth.type <= kBirthTypeMax;
}

}  // namespace relief
