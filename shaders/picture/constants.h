// SPDX-License-Identifier: Apache-2.0
// Constants of pictures that C++ and GLSL share (shaders/embed.cmake).
#pragma once

namespace relief {

/// Values of a digit of the radix sort, and invocations of its work groups.
inline constexpr int kRadixDigits = 256;
/// Pixels of a side of a tile (tile.glsl).
inline constexpr int kTileSide = 16;
/// Words of b_work.
inline constexpr int kTileWords = 7;
/// The most entries of one tile, painted in a millisecond.
inline constexpr int kTileEntriesMax = 1 << 16;

/// Texels before the keys in a row of looks, and texels of a key.
inline constexpr int kLookHeadTexels = 3;
inline constexpr int kLookKeyTexels = 2;

/// Radius of the sun's disc at distance 1, and the reach of shade of the sky, in longest sides of the collider.
inline constexpr float kSunWidth = 0.1F;
inline constexpr float kSkyReach = 0.45F;
/// Texels of the sun's map that a particle looks up.
inline constexpr int kSunSamples = 6;
/// In the sun's map, where nothing shades; object units.
inline constexpr float kNoShade = 1e30F;

/// Vertices of a sprite that is a quad.
inline constexpr int kQuadVertices = 6;

}  // namespace relief
