// SPDX-License-Identifier: Apache-2.0
// Keys of particle types and of births by events.
#pragma once

#include "formats/base/field.h"
#include "formats/base/scene_limits.h"
#include "runtime/events/spawner.h"
#include "runtime/particles/particle_type.h"

namespace relief {

/// All fields except `collides_with`, which refers to bodies by name.
void fields(FieldVisitor& visit, ParticleType& type);

void fields(FieldVisitor& visit, SpawnSettings& s);

}  // namespace relief
