// SPDX-License-Identifier: Apache-2.0
// Moving air and fields in the step of a particle system.
#pragma once

#include "formats/base/result.h"
#include "runtime/air/air.h"
#include "runtime/particles/particle_system.h"

namespace relief {

/// Moving air and fields from the next step on. Its wind takes the place of Forces::wind; its viscosity is ignored, because
/// Forces has one. Fails as AirBlock::create and ParticleSystem::replaceFeature do.
[[nodiscard]] Result<void> setAir(ParticleSystem& particles, const AirSettings& air);

}  // namespace relief
