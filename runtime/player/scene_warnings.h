// SPDX-License-Identifier: Apache-2.0
// Settings of a scene that are valid but probably mistakes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/particles/particle_system.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// Chooses collision.sweep if the scene does not state it and a step is longer than a collider is thick: half of the thinnest, or
/// what the pieces of a sweep reach. Colliders that deform are left out.
/// \return one line at most: colliders that are still thinner than a step or than the sweep, so that particles pass through
/// them; how many there are, the thinnest, and the cure for all.
[[nodiscard]] std::vector<std::string> fitSweep(LoadedScene& loaded);

/// A warning about a run in which most births found no free place.
[[nodiscard]] std::optional<std::string> refusedWarning(const ParticleCounts& counts, std::uint32_t capacity);

}  // namespace relief
