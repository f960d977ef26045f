// SPDX-License-Identifier: Apache-2.0
// The bodies of a world (formats/world) as WorldTextures takes them.
//
//     const LoadedWorld level = *loadWorld("level/world.json");
//     WorldTextures textures = *WorldTextures::create(worldBodies(level));
//     std::vector<Pose> poses = worldPoses(level.world);
//     for (const std::size_t tile : findBodies(level.world, "door")) {
//         poses[tile].position.y += 0.1F;
//     }
//     textures.setPoses(poses);   // before each step while the door moves, and once more when it has stopped
#pragma once

#include <vector>

#include "formats/world/pose.h"
#include "formats/world/world.h"
#include "runtime/bodies/world_textures.h"

namespace relief {

/// In the world's order, each with its pose and response. They point to the colliders of `world`, which must stay until they
/// are uploaded.
[[nodiscard]] std::vector<ColliderBody> worldBodies(const LoadedWorld& world);
/// The poses of all bodies, in the world's order.
[[nodiscard]] std::vector<Pose> worldPoses(const World& world);

}  // namespace relief
