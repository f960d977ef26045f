// SPDX-License-Identifier: Apache-2.0
// Types of particles: how each moves and collides.
#pragma once

#include <cstddef>
#include <cstdint>

#include "formats/base/enum_words.h"
#include "shaders/particles/constants.h"

namespace relief {

/// Bits of ParticleType::collides: group g of the bodies (ColliderBody::group), of which a single collider is 0, has bit g.
inline constexpr std::uint32_t kCollidesWithGround = 1U << kGroundBit;
inline constexpr std::uint32_t kCollidesWithAll = 2 * kCollidesWithGround - 1;

struct ParticleType {
    float gravity = 1.0F;  ///< factor of Forces::gravity, finite; below 0 it rises
    float mass = 1.0F;     ///< divides the drag; at least kParticleMassMin
    float radius = 0.0F;   ///< of collision, world units, ≥ 0
    /// ε, 0…1: how much comes back of the normal speed at the beginning of the step.
    float restitution = 0.0F;
    float friction = 0.0F;            ///< ν, 0…1: how much of the tangential speed is lost
    float friction_threshold = 0.0F;  ///< no friction below this speed, world units a second
    OnCollision on_collision = OnCollision::kBounce;
    float lifetime_loss = 0.0F;                 ///< seconds of life that each step in contact costs, ≥ 0
    std::uint32_t collides = kCollidesWithAll;  ///< what it does not go through: a sum of bits
};

inline constexpr std::size_t kParticleTypesMax = 16;
/// With less, drag over mass times wind is no float any more.
inline constexpr float kParticleMassMin = 1e-15F;

template <>
inline constexpr std::array<std::string_view, 4> kWordsOf<OnCollision>{"bounce", "stop", "slide", "die"};

}  // namespace relief
