// SPDX-License-Identifier: Apache-2.0
// Particle states as PLY.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "runtime/particles/particle_system.h"

namespace relief {

/// Binary little-endian PLY, one vertex a particle in ascending order of id, 40 bytes each: float x y z
/// (object units), vx vy vz (object units a second), age, lifetime (seconds), uint id (births before its
/// own), type.
[[nodiscard]] std::vector<std::byte> encodePly(std::span<const ParticleState> particles);

}  // namespace relief
