// SPDX-License-Identifier: Apache-2.0
// Encodes particle states as PLY.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runtime/particles/particle_system.h"

namespace relief {

/// Encodes particles as binary little-endian PLY: one vertex of 40 bytes per particle, in ascending order of id.
/// Properties: float x y z (object units), vx vy vz (object units/s), age, lifetime (seconds), uint id (number of
/// earlier births), type.
[[nodiscard]] std::vector<std::byte> encodePly(std::span<const ParticleState> particles);

}  // namespace relief
