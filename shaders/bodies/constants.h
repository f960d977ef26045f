// SPDX-License-Identifier: Apache-2.0
// Constants of worlds of bodies that C++ and GLSL share (shaders/embed.cmake).
#pragma once

namespace relief {

/// Texels of a map, of a body, and levels of both grids in a world (bodies/world.glsl).
inline constexpr int kWorldMapTexels = 9;
inline constexpr int kWorldBodyTexels = 8;
inline constexpr int kWorldLevels = 16;

/// Of materials (bodies/materials.glsl): texels of a body, and the flag of a brick among entries.
inline constexpr int kMaterialHeadTexels = 2;
inline constexpr int kMaterialIsBrick = 0x40000000;

}  // namespace relief
