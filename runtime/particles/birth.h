// SPDX-License-Identifier: Apache-2.0
// One particle to be born.
#pragma once

#include <cmath>
#include <cstdint>
#include <glm/vec3.hpp>

#include "formats/base/finite.h"

namespace relief {

struct Birth {
    glm::vec3 position{0.0F};  ///< object units
    glm::vec3 velocity{0.0F};  ///< object units a second
    float lifetime = 1.0F;     ///< seconds, > 0
    std::uint32_t type = 0;    ///< carried along for the renderer, below 2^24
    /// Seconds that it has lived already when it enters the next step, ≥ 0. The particle system moves it on
    /// by as much, so that those born within one step do not all start from one place.
    float age = 0.0F;
};

inline constexpr std::uint32_t kBirthTypeMax = (1U << 24) - 1;  // what a float counts exactly

/// A particle system accepts it: all numbers are finite and in the ranges above.
[[nodiscard]] inline bool isValid(const Birth& birth) {
    return isFinite(birth.position) && isFinite(birth.velocity) && birth.lifetime > 0.0F &&
           std::isfinite(birth.lifetime) && birth.age >= 0.0F && std::isfinite(birth.age) &&
           birth.type <= kBirthTypeMax;
}

}  // namespace relief
