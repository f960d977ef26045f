// SPDX-License-Identifier: Apache-2.0
// Constants of particles shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// The effect of a collision on a particle. Particles caught inside a solid always leave it first.
enum class OnCollision : std::uint8_t {
    kBounce = 0,  ///< the paper's reaction, with restitution and friction
    kStop = 1,    ///< stays at the contact point and moves with the surface (snow)
    kSlide = 2,   ///< keeps only the tangential velocity
    kDie = 3,     ///< disappears at once; its index is freed at the end of its lifetime
};

/// Bit of the floor in ParticleType::collides_with; lower bits are groups of bodies.
inline constexpr int kGroundBit = 8;

/// A particle's contact in the last step. The state texture stores kStopped for the floor, kStopped + 1 + b for body b.
enum class Contact : std::uint8_t {
    kNone = 0,
    kCollided = 1,
    kCaught = 2,
    kStopped = 3,  ///< permanently at rest (OnCollision::kStop)
};

/// The state texture stores the fraction of the lifetime lost to materials as the fractional part of the contact, in at
/// least 7 bits for 65,536 bodies. Fractions of kLostMax and above count as 1.
inline constexpr float kLostMax = 0.9921875F;

/// Dead particles: their height, out of sight, and their collision count.
inline constexpr float kDeadHeight = -1e30F;
inline constexpr float kDeadCollisions = -1.0F;

/// Texels per work group of a compute step. GPUs tile textures in memory: on an H100, 8 x 8 is 6 % faster than 16 x 8
/// or 128 x 1.
inline constexpr int kStepGroupWidth = 8;
inline constexpr int kStepGroupHeight = 8;

/// Invocations per work group of births.
inline constexpr int kBirthGroup = 64;

}  // namespace relief
