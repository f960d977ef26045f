// SPDX-License-Identifier: Apache-2.0
// Constants of worlds of bodies shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

namespace relief {

/// Texels per map and per body, and total levels of the grids of resting and of moving bodies (bodies/world.glsl).
inline constexpr int kWorldMapTexels = 9;
inline constexpr int kWorldBodyTexels = 8;
inline constexpr int kWorldLevels = 16;

/// Materials: texels per body, and the flag of entries that point to bricks (bodies/materials.glsl).
inline constexpr int kMaterialHeadTexels = 2;
inline constexpr int kMaterialIsBrick = 0x40000000;

}  // namespace relief
