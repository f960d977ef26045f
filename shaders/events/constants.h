// SPDX-License-Identifier: Apache-2.0
// Constants of events shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// Bit flags of a particle's event in a step.
enum EventFlag : std::int32_t {
    kEventCollision = 1,
    kEventLasts = 2,  ///< with kEventCollision: there was also contact in the previous step
    kEventDeath = 4,  ///< by the collision if kEventCollision is also set, otherwise by age
};
/// The step writes flags + kEventFlags · (direction + kEventDirections · (m + (materials + 1) · (body + 1))), below
/// 2^24. direction: axis and sign of the normal's largest component (step_event.glsl). m: index of the material's
/// name + 1, or 0 without a material. materials: number of names. body: -1 for the floor. Lists store flags +
/// kEventFlags · m.
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
