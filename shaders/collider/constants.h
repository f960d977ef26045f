// SPDX-License-Identifier: Apache-2.0
// Constants of colliders that C++ and GLSL share (shaders/embed.cmake).
#pragma once

#include <cstdint>

namespace relief {

/// Flags of a map in the block of collider.glsl: their sum.
enum MapFlag : std::int32_t {
    kKeepsFarthest = 1,
    kEncloses = 2,
    kEmptyIsOutside = 4,
    kDecodesPlane = 8,
};

/// The first maps of a collider, which a step evaluates one after another, each by code of its own.
inline constexpr int kUnrolledMaps = 8;

/// The shader storage binding of the collider in a tour (collider_tour.glsl).
inline constexpr int kTourStorage = 0;

}  // namespace relief
