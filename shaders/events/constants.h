// SPDX-License-Identifier: Apache-2.0
// Constants of events shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// Bit flags of a particle's event in a step.
enum EventFlag : std::int32_t {
    kEventCollision = 1,
    kEventLasts = 2,  ///< with kEventCollision: there was also contact in the previous step
    kEventDeath = 4,  ///< by age, or with kEventCollision by the collision
};
/// The step writes flags + kEventFlags · (direction + kEventDirections · (m + (materials + 1) · (body + 1))), below
/// 2^24, where m is the index of the material's name + 1, or 0 without a material. Lists store flags + kEventFlags · m.
inline constexpr int kEventFlags = 8;
inline constexpr int kEventDirections = 6;
/// Each count sums this many counts of the level below; kEventLevels levels suffice for the largest system.
inline constexpr int kEventsPerCount = 64;
inline constexpr int kEventLevels = 4;
/// Maximum event lists per step: counts have one component for each.
inline constexpr int kEventLists = 4;
/// Texels per row of the counts and of the event list.
inline constexpr int kEventsWidth = 1024;

}  // namespace relief
