// SPDX-License-Identifier: Apache-2.0
// Constants of events that C++ and GLSL share (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// The events of a particle in a step: the sum of these.
enum EventFlag : std::int32_t {
    kEventCollision = 1,
    kEventLasts = 2,  ///< beside kEventCollision: the step before touched something, too
    kEventDeath = 4,  ///< of age, or beside kEventCollision of the collision
};
/// The step writes flags + kEventFlags · (direction + kEventDirections · (m + (materials + 1) · (body + 1))), below 2^24, with m the
/// number of the material's name + 1, or 0 without one. In a list it is flags + kEventFlags · m.
inline constexpr int kEventFlags = 8;
inline constexpr int kEventDirections = 6;
/// A count of events is that of so many counts before it; kEventLevels of them count the largest system.
inline constexpr int kEventsCounted = 64;
inline constexpr int kEventLevels = 4;
/// Lists of the events of a step: a count has a component for each.
inline constexpr int kEventLists = 4;
/// Texels in a row of the counts and of the list of events.
inline constexpr int kEventsWidth = 1024;

}  // namespace relief
