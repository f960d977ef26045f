// SPDX-License-Identifier: Apache-2.0
// The sweep of a scene that does not state it.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/collider.h"
#include "runtime/particles/emitter.h"
#include "runtime/scene/scene.h"

namespace relief {

/// Chooses collision.sweep if the scene does not state it and a step is longer than a collider is thick: half of the thinnest, or
/// what the pieces of a sweep reach. Colliders that deform are left out.
/// \param scene     complete, with every default.
/// \param colliders as many as the scene has.
/// \param emitters  as many as the scene has, before their first birth.
/// \param bounds    of all colliders, in the particles' space.
/// \return one line at most: colliders that are still thinner than a step or than the sweep, so that particles pass through
/// them; how many there are, the thinnest, and the cure for all.
[[nodiscard]] std::vector<std::string> fitSweep(Scene& scene,
                                                std::span<const std::shared_ptr<const Collider>> colliders,
                                                std::span<const Emitter> emitters, const Bounds& bounds);

}  // namespace relief
