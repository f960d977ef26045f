// SPDX-License-Identifier: Apache-2.0
// Adds the bodies of a world to the colliders of a scene.
#pragma once

#include <filesystem>

#include "formats/base/result.h"
#include "formats/world/world.h"
#include "runtime/scene/scene.h"

namespace relief {

/// Returns the path of a container of the world.
[[nodiscard]] std::filesystem::path containerOf(const Scene& scene, const WorldFile& file);

/// Places the bodies of a world. If a collider names a node, the body of that node provides its container, scale,
/// restitution, friction, and the missing values of its pose.
/// The other bodies are appended in the order of the world, followed by the further bodies of the named nodes,
/// which are tiles of a large mesh with the same pose.
/// \param world  the contents of scene.world.
/// Errors, with the place in the scene: kInvalidInput (a node without a body, with several bodies in different places,
/// or named by two colliders); kLimit (more bodies than WorldTextures supports).
[[nodiscard]] Result<void> placeBodies(Scene& scene, const World& world);

}  // namespace relief
