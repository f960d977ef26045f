// SPDX-License-Identifier: Apache-2.0
// Constants of particles that C++ and GLSL share (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// The effect of a collision on a particle; one that is caught inside always leaves first.
enum class OnCollision : std::uint8_t {
    kBounce = 0,  ///< the paper's reaction, by restitution and friction
    kStop = 1,    ///< stays where it touches, and goes with what it touched (snow)
    kSlide = 2,   ///< keeps the tangential part of its velocity alone
    kDie = 3,     ///< out of sight at once; its place is free again at the end of its lifetime
};

/// The bit of the floor in ParticleType::collides; those below it are of bodies.
inline constexpr int kGroundBit = 8;

/// The outcome of the last step. The state texture holds kStopped for the floor and kStopped + 1 + b for body b.
enum class Contact : std::uint8_t {
    kNone = 0,
    kCollided = 1,
    kCaught = 2,
    kStopped = 3,  ///< at rest for good (OnCollision::kStop)
};

/// The state texture has the share of its lifetime that a particle has lost behind the point of its contact, in at least 7 bits,
/// for 65,536 bodies: this and more stand for all of it.
inline constexpr float kLostMost = 0.9921875F;

/// Dead particles: their height, out of sight, and their number of collisions.
inline constexpr float kDeadHeight = -1e30F;
inline constexpr float kDeadCollisions = -1.0F;

/// Texels of a work group of a compute step. Textures lie in memory by squares: on an H100 8 x 8 is 6 % faster than 16 x 8
/// or 128 x 1.
inline constexpr int kStepGroupWidth = 8;
inline constexpr int kStepGroupHeight = 8;

/// Invocations of a work group of births.
inline constexpr int kBirthGroup = 64;

}  // namespace relief
