// SPDX-License-Identifier: Apache-2.0
// The core for programs that embed Relief: a collider, its textures, an emitter, the particles. Installed as
// <relief/relief.hpp>. Each layer has headers of its own: <runtime/picture/particle_renderer.h>, <runtime/air/particle_air.h>.
#pragma once

#include "formats/collider.h"
#include "formats/container.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/particle_system.h"
