// SPDX-License-Identifier: Apache-2.0
// Adds moving air and force fields to a particle system.
#pragma once

#include "formats/base/result.h"
#include "runtime/air/air.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// Sets the air for subsequent steps. Its wind replaces Forces::wind. Its viscosity is ignored; set Forces::viscosity
/// instead. Errors: those of AirBlock::create and ParticleSystem::replaceFeature.
[[nodiscard]] Result<void> setAir(ParticleSystem& particles, const AirSettings& air);

}  // namespace relief
