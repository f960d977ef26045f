// SPDX-License-Identifier: Apache-2.0
// Constants of pictures shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

namespace relief {

/// Number of values of a radix sort digit, and of invocations per work group.
inline constexpr int kRadixDigits = 256;
/// Side of a tile in pixels (tile.glsl).
inline constexpr int kTileSide = 16;
/// 32-bit words in the buffer b_work (tile.glsl).
inline constexpr int kTileWords = 7;
/// Maximum entries per tile; they are painted in a millisecond.
inline constexpr int kTileEntriesMax = 1 << 16;

/// Texels before the keys in a row of u_looks, and texels per key.
inline constexpr int kLookHeadTexels = 3;
inline constexpr int kLookKeyTexels = 2;

/// Radius of the sun's disc at distance 1, and the range of sky occlusion as a multiple of the collider's longest side.
inline constexpr float kSunWidth = 0.1F;
inline constexpr float kSkyReach = 0.45F;
/// Texels of the sun map that a particle samples.
inline constexpr int kSunSamples = 6;
/// Value of the sun map where nothing casts a shadow; object units.
inline constexpr float kNoShade = 1e30F;

/// Vertices of a sprite drawn as a quad.
inline constexpr int kQuadVertices = 6;

}  // namespace relief
