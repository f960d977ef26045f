// SPDX-License-Identifier: Apache-2.0
// All that a program needs which embeds Relief: colliders, particles, pictures. Installed as <relief/relief.hpp>.
#pragma once

#include "formats/collider.h"
#include "formats/container.h"
#include "formats/nearest_surface.h"
#include "formats/world/world_field.h"
#include "runtime/air/air.h"
#include "runtime/collider/collider_textures.h"
#include "runtime/collider/live_collider.h"
#include "runtime/collider/world_bodies.h"
#include "runtime/gl/gl_context.h"
#include "runtime/particles/emitter.h"
#include "runtime/particles/mesh_trail.h"
#include "runtime/particles/particle_system.h"
#include "runtime/particles/spawner.h"
#include "runtime/picture/collider_renderer.h"
#include "runtime/picture/depth_sort.h"
#include "runtime/picture/particle_renderer.h"
#include "runtime/stream/world_stream.h"
