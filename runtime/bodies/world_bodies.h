// SPDX-License-Identifier: Apache-2.0
// Converts the bodies of a world (formats/world) into the input of WorldTextures.
//
//     const LoadedWorld level = *loadWorld("level/world.json");
//     WorldTextures textures = *WorldTextures::create(worldBodies(level));
//     std::vector<Pose> poses = worldPoses(level.world);
//     for (const std::size_t tile : findBodies(level.world, "door")) {
//         poses[tile].position.y += 0.1F;
//     }
//     textures.setPoses(poses);   // before each step while the door moves, and once after it stops
#pragma once

#include <vector>

#include "formats/world/pose.h"
#include "formats/world/world.h"
#include "runtime/bodies/world_textures.h"

namespace relief {

/// Returns the bodies in world order, with poses and responses. The bodies point to colliders of `world`, which must
/// exist until WorldTextures::create() returns.
[[nodiscard]] std::vector<ColliderBody> worldBodies(const LoadedWorld& world);
/// Returns the poses of all bodies, in world order.
[[nodiscard]] std::vector<Pose> worldPoses(const World& world);

}  // namespace relief
