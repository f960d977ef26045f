// The numbers that C++ and GLSL share: each is defined here or, where containers know it too, in formats/, and every
// shader is compiled with all of them as #defines. So no shader has a number of its own that C++ must agree with.
#pragma once

#include <cstdint>
#include <string>

namespace relief {

/// Flags of a map in the block of collider.glsl: their sum.
enum MapFlag : std::int32_t {
    kKeepsFarthest = 1,
    kEncloses = 2,
    kEmptyIsOutside = 4,
    kDecodesPlane = 8,
    kIsGap = 32,    ///< front-back: outside only where both ends say so
    kHasRows = 16,  ///< front-back: a texel for each row says which of its texels there are
};

/// What a collision does to a particle; one that is caught inside always leaves first.
enum class OnCollision : std::uint8_t {
    kBounce = 0,  ///< the paper's reaction, by restitution and friction
    kStop = 1,    ///< stays where it touches, and goes with what it touched (snow)
    kSlide = 2,   ///< keeps the tangential part of its velocity alone
    kDie = 3,     ///< out of sight at once; its place is free again at the end of its lifetime
};

/// The bit of the floor in ParticleType::collides; those below it are of bodies.
inline constexpr int kGroundBit = 8;

/// What the last step did to a particle. The state texture holds kStopped for the floor and kStopped + 1 + b for
/// body b.
enum class Contact : std::uint8_t {
    kNone = 0,
    kCollided = 1,
    kCaught = 2,
    kStopped = 3,  ///< at rest for good (OnCollision::kStop)
};

/// What happened to a particle in a step: the sum of these, 0 where nothing did.
enum EventFlag : std::int32_t {
    kEventCollision = 1,
    kEventLasts = 2,  ///< beside kEventCollision: the step before touched something, too
    kEventDeath = 4,  ///< of age, or beside kEventCollision of the collision
};
/// The step writes flags + kEventFlags · (direction + kEventDirections · (body + 1)), as events.glsl has it.
inline constexpr int kEventFlags = 8;
inline constexpr int kEventDirections = 6;
/// A count of events is that of so many counts before it; kEventLevels of them count the largest system.
inline constexpr int kEventsCounted = 64;
inline constexpr int kEventLevels = 4;
/// Texels in a row of the counts and of the list of events.
inline constexpr int kEventsWidth = 1024;

/// With Verlet one float holds both counts of a particle: collisions + contact / kContactParts. Beyond the largest
/// number of collisions it would lose the parts.
inline constexpr float kContactParts = 16.0F;
inline constexpr float kVerletCollisionsMax = 524287.0F;  // 2^19 - 1

/// Where the dead are, out of everybody's sight, and how many collisions they have.
inline constexpr float kDeadHeight = -1e30F;
inline constexpr float kDeadCollisions = -1.0F;

/// Texels of a work group of a compute step. Textures lie in memory by squares: on an H100 8 x 8 is 6 % faster than 16 x 8
/// or 128 x 1.
inline constexpr int kStepGroupWidth = 8;
inline constexpr int kStepGroupHeight = 8;

/// The shader storage binding of the collider in a tour (collider_tour.glsl).
inline constexpr int kTourStorage = 0;

/// Values of a digit of the radix sort, and invocations of its work groups.
inline constexpr int kRadixDigits = 256;
/// Pixels of a side of a tile (tile.glsl).
inline constexpr int kTileSide = 16;
/// Of b_work.
inline constexpr int kTileWords = 7;
/// Of one tile, painted in a millisecond.
inline constexpr int kTileEntriesMax = 1 << 16;

/// Invocations of a work group of births.
inline constexpr int kBirthGroup = 64;

/// A pass of the statistics sums squares of so many texels a side.
inline constexpr int kReducedSide = 4;
/// Squares a side of a work group: those that its second pass and its third sum into one.
inline constexpr int kReducedGroup = kReducedSide * kReducedSide;
/// Sums of collisions are kept as low + kCollisionsHigh · high.
inline constexpr int kCollisionsHigh = 4096;
/// A type is found by the greatest of kTypeCodes - type.
inline constexpr float kTypeCodes = 256.0F;
/// Beyond this speed, world units a second, a particle counts as lost: the squares of 2^24 of them are still floats.
inline constexpr float kSpeedMaxOfState = 1e15F;

/// The most attractors, and the most vortices, in the block of air.glsl.
inline constexpr int kAirFieldsMax = 8;
/// 6π, of Stokes drag.
inline constexpr float kSixPi = 18.849556F;
/// Beyond so many units of the lattice from the origin floats no longer resolve a cell of curl noise.
inline constexpr float kCurlCellMax = 1048576.0F;
/// Patterns of curl noise, of the first octave, before they repeat.
inline constexpr int kCurlPatterns = 128;

enum class DeformKind : std::uint8_t { kBend = 0, kTwist = 1, kWobble = 2 };

/// Texels before the keys in a row of looks, and texels of a key.
inline constexpr int kLookHeadTexels = 3;
inline constexpr int kLookKeyTexels = 2;

/// Radius of the sun's disc at distance 1, and how far shade of the sky reaches, in longest sides of the collider.
inline constexpr float kSunWidth = 0.1F;
inline constexpr float kSkyReach = 0.45F;
/// Texels of the sun's map that a particle looks up.
inline constexpr int kSunSamples = 6;
/// In the sun's map, where nothing shades; object units.
inline constexpr float kNoShade = 1e30F;

/// Vertices of a sprite that is a quad.
inline constexpr int kQuadVertices = 6;

/// "#define RELIEF_BOUNCE 0.0\n" and so on. makeProgram puts them before every shader.
[[nodiscard]] const std::string& shaderConstants();

}  // namespace relief
