// SPDX-License-Identifier: Apache-2.0
// A world for tests of placed bodies.
#pragma once

#include "formats/world/world.h"

namespace relief::test {

/// Three bodies of two colliders; the second body is rotated and scaled.
inline World threeBodies() {
    World world;
    world.colliders = {{{"floor.relief", "", 0}, "floor", {glm::vec3(-9.0F), glm::vec3(9.0F)}, {}},
                       {{"door.relief", "", 0}, "door", {glm::vec3(0.0F), glm::vec3(1.0F, 2.0F, 0.1F)}, {}}};
    world.bodies = {{.collider = 0, .node = "floor"},
                    {.collider = 1,
                     .node = "door",
                     .position = {3.0F, 0.5F, 1.0F},
                     .rotation = {0.0F, 0.6F, 0.0F, 0.8F},
                     .scale = 2.0F,
                     .restitution = 0.25F,
                     .friction = 0.75F},
                    {.collider = 1, .node = "gate", .position = {-3.0F, 0.0F, 0.0F}}};
    return world;
}

/// Adds another tile of body `of`, with the same pose, as body `at`.
inline void addTile(World& world, std::size_t of, const char* file, std::size_t at) {
    WorldBody tile = world.bodies[of];
    world.colliders.push_back(world.colliders[tile.collider]);
    world.colliders.back().file = file;
    tile.collider = static_cast<std::uint32_t>(world.colliders.size() - 1);
    world.bodies.insert(world.bodies.begin() + static_cast<std::ptrdiff_t>(at), tile);
}

}  // namespace relief::test
