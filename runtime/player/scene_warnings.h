// SPDX-License-Identifier: Apache-2.0
// Warnings of what is valid in a scene, and probably not meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/particles/particle_system.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// One line at most: bodies whose thickness is below the length of a step, so that particles pass through them; how many there
/// are, the thinnest, and the cure for all. Bodies that deform are left out.
[[nodiscard]] std::vector<std::string> sceneWarnings(const LoadedScene& loaded);

/// The same, of a run: most births found no free place.
[[nodiscard]] std::optional<std::string> refusedWarning(const ParticleCounts& counts, std::uint32_t capacity);

}  // namespace relief
