// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_world.h"

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/base/text.h"

namespace relief {
namespace {

/// Bodies of each node, in the order of the world.
using BodiesOfNodes = std::map<std::string_view, std::vector<std::size_t>>;

/// \return the numbers of the bodies, at least one, all with the same pose.
Result<std::vector<std::size_t>> bodiesNamed(const Scene& scene, const World& world,
                                             const BodiesOfNodes& nodes, std::size_t collider) {
    const SceneCollider& from = scene.colliders[collider];
    const std::string named =
        from.origin + ": collider[" + std::to_string(collider) + "].node = '" + cleanUtf8(from.node) + "' ";
    const auto found = nodes.find(from.node);
    if (found == nodes.end()) {
        return invalidInput(named + "is not a node of a body in " + quotedPath(scene.world) +
                            "; use a \"node\" of its \"bodies\"");
    }
    const std::vector<std::size_t>& bodies = found->second;
    const Pose first = poseOf(world.bodies[bodies.front()]);
    for (const std::size_t body : bodies) {
        if (!(poseOf(world.bodies[body]) == first)) {
            return invalidInput(named + "has " + std::to_string(bodies.size()) + " bodies in " +
                                quotedPath(scene.world) +
                                " with different poses; give their nodes different names");
        }
    }
    return bodies;
}

/// Places a collider at a body. \param to  keeps its keys, and the values of its pose that are set.
void place(SceneCollider& to, const WorldBody& body, const Scene& scene, const World& world) {
    to.path = containerOf(scene, world.colliders[body.collider]);
    to.origin = scene.world_origin;
    to.node = body.node;
    to.posed = true;
    to.scale = body.scale;
    to.restitution = body.restitution;
    to.friction = body.friction;
    completePoses(to, poseOf(body));
}

}  // namespace

std::filesystem::path containerOf(const Scene& scene, const WorldFile& file) {
    return scene.world.parent_path() / file.file;
}

Result<void> placeBodies(Scene& scene, const World& world) {
    BodiesOfNodes nodes;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        nodes[world.bodies[i].node].push_back(i);
    }
    std::vector<bool> placed(world.bodies.size());
    std::vector<std::pair<std::size_t, std::size_t>> tiles;  // collider that names the node, and body
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        SceneCollider& collider = scene.colliders[i];
        if (collider.node.empty()) {
            continue;
        }
        const std::vector<std::size_t> bodies = RELIEF_TRY(bodiesNamed(scene, world, nodes, i));
        if (placed[bodies.front()]) {
            return invalidInput(collider.origin + ": collider[" + std::to_string(i) + "].node = '" +
                                cleanUtf8(collider.node) + "' is named by two colliders; remove one of them");
        }
        place(collider, world.bodies[bodies.front()], scene, world);
        for (const std::size_t body : bodies) {
            placed[body] = true;
            if (body != bodies.front()) {
                tiles.emplace_back(i, body);
            }
        }
    }
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        if (!placed[i]) {
            place(scene.colliders.emplace_back(), world.bodies[i], scene, world);
        }
    }
    // Appended last, so that other bodies have the same numbers as with an undivided mesh.
    for (const auto& [collider, body] : tiles) {
        SceneCollider tile = scene.colliders[collider];  // copies the poses exactly
        tile.tile_of = collider;
        tile.path = containerOf(scene, world.colliders[world.bodies[body].collider]);
        tile.restitution = world.bodies[body].restitution;
        tile.friction = world.bodies[body].friction;
        scene.colliders.push_back(std::move(tile));
    }
    if (scene.colliders.size() > WorldTextures::kBodiesMax) {
        return fail(ErrorCode::kLimit,
                    scene.world_origin + ": the world's " + std::to_string(world.bodies.size()) +
                        " bodies and the other colliders of the scene exceed the maximum of " +
                        std::to_string(WorldTextures::kBodiesMax) + "; remove some");
    }
    return {};
}

}  // namespace relief
