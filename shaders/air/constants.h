// SPDX-License-Identifier: Apache-2.0
// Constants of the air that C++ and GLSL share (shaders/embed.cmake).
#pragma once

namespace relief {

/// The most attractors, and the most vortices, in the block of air.glsl.
inline constexpr int kAirFieldsMax = 8;
/// Beyond so many units of the lattice from the origin floats no longer resolve a cell of curl noise.
inline constexpr float kCurlCellMax = 1048576.0F;
/// Patterns of curl noise, of the first octave, before they repeat.
inline constexpr int kCurlPatterns = 128;

}  // namespace relief
