// Warnings of what is valid in a scene, and probably not meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "runtime/particles/particle_system.h"
#include "runtime/scene/loaded_scene.h"

namespace relief {

/// How thick a body is at most places of its surface, straight inwards; object units. nullopt where its maps do not tell.
[[nodiscard]] std::optional<float> typicalThickness(const Collider& collider);

/// One line each, with the cure, in this order: steps longer than a body is thick, which particles pass through; births
/// inside of a body; gravity far from the Earth's where lengths are metres. Bodies that deform are left out.
[[nodiscard]] std::vector<std::string> sceneWarnings(const LoadedScene& loaded);

/// The same, of a run: most births found no free place.
[[nodiscard]] std::optional<std::string> refusedWarning(const ParticleCounts& counts, std::uint32_t capacity);

}  // namespace relief
