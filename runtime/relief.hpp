// SPDX-License-Identifier: Apache-2.0
// The core for programs that embed Relief: collider, textures, emitter and particles. Installed as <relief/relief.hpp>.
// Other layers have their own headers, such as <runtime/picture/particle_renderer.h> and <runtime/air/particle_air.h>.
#pragma once

#include "formats/collider.h"
#include "formats/container.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_system.h"
