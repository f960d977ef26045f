// SPDX-License-Identifier: Apache-2.0
// Constants of colliders shared by C++ and GLSL (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// Bit flags of a map in the block of collider.glsl.
enum MapFlag : std::int32_t {
    kKeepsFarthest = 1,
    kEncloses = 2,
    kEmptyIsOutside = 4,
    kDecodesPlane = 8,
};

/// A step evaluates this many maps of a collider without a loop, and the others in a loop.
inline constexpr int kUnrolledMaps = 8;

/// Shader storage binding of the block ReliefMapsStorage (maps.glsl) if collider_tour.glsl evaluates the collider.
inline constexpr int kTourStorage = 0;

}  // namespace relief
