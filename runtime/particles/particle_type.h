// SPDX-License-Identifier: Apache-2.0
// Particle types: motion and collision parameters.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/base/enum_words.h"
#include "shaders/particles/constants.h"

namespace relief {

/// Bits of ParticleType::collides_with: body group g (ColliderBody::group) has bit g. A single collider is in group 0.
inline constexpr std::uint32_t kCollidesWithGround = 1U << kGroundBit;
inline constexpr std::uint32_t kCollidesWithAll = 2 * kCollidesWithGround - 1;

struct ParticleType {
    float gravity = 1.0F;  ///< multiplies Forces::gravity, finite; negative: rises
    float mass = 1.0F;     ///< divides the drag; at least kParticleMassMin
    float radius = 0.0F;   ///< collision radius, world units, ≥ 0
    /// ε, 0…1: a bounce restores this fraction of the normal speed at the start of the step.
    float restitution = 0.0F;
    float friction = 0.0F;            ///< ν, 0…1: fraction of the tangential speed that is lost
    float friction_threshold = 0.0F;  ///< no friction below this speed, world units/s
    OnCollision on_collision = OnCollision::kBounce;
    float lifetime_loss = 0.0F;  ///< seconds of lifetime lost in each step in contact, ≥ 0
    std::uint32_t collides_with = kCollidesWithAll;  ///< bit mask of body groups and the ground
};

inline constexpr std::size_t kParticleTypesMax = 16;
/// Below this, drag / mass · wind overflows a float.
inline constexpr float kParticleMassMin = 1e-15F;

template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<OnCollision>{"bounce", "stop", "slide", "die"};

}  // namespace relief
