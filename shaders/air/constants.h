// SPDX-License-Identifier: Apache-2.0
// Constants of the air shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

namespace relief {

/// Maximum number of attractors, and of vortices, in the block of air.glsl.
inline constexpr int kAirFieldsMax = 8;
/// Maximum distance from the origin in lattice units: beyond it, floats do not resolve a cell of curl noise.
inline constexpr float kCurlCellMax = 1048576.0F;
/// Curl noise repeats in time after this many patterns of the first octave.
inline constexpr int kCurlPatterns = 128;

}  // namespace relief
