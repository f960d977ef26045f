// SPDX-License-Identifier: Apache-2.0
// The bodies of a scene's world as colliders of the scene.
#pragma once

#include <filesystem>

#include "formats/base/result.h"
#include "formats/world/world.h"
#include "runtime/scene/scene.h"

namespace relief {

/// The path of a container of the scene's world.
[[nodiscard]] std::filesystem::path containerOf(const Scene& scene, const WorldFile& file);

/// Gives the colliders that name a node the body that it places, where they leave its pose open; the other bodies of the
/// world follow behind all colliders, in the world's order, and last the other bodies of those nodes, in the same place: the
/// tiles of a large mesh.
/// \param world  of scene.world.
/// Errors, with the place in the scene: kInvalidInput (a node without a body, with several in different places, or that two
/// colliders name);
/// kLimit (more bodies than WorldTextures takes).
[[nodiscard]] Result<void> placeBodies(Scene& scene, const World& world);

}  // namespace relief
