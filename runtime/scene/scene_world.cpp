#include "runtime/scene/scene_world.h"

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "formats/base/file_io.h"
#include "formats/base/text.h"
#include "runtime/collider/world_bodies.h"

namespace relief {
namespace {

/// The bodies of each node, in the world's order.
using BodiesOfNodes = std::map<std::string_view, std::vector<std::size_t>>;

BodiesOfNodes bodiesOfNodes(const World& world) {
    BodiesOfNodes nodes;
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        nodes[world.bodies[i].node].push_back(i);
    }
    return nodes;
}

/// \return its number in the world.
Result<std::size_t> bodyNamed(const Scene& scene, const BodiesOfNodes& nodes, std::size_t collider) {
    const std::string& node = scene.colliders[collider].node;
    const auto found = nodes.find(node);
    const std::size_t bodies = found == nodes.end() ? 0 : found->second.size();
    if (bodies == 1) {
        return found->second.front();
    }
    const std::string named =
        scene.world_origin + ": collider[" + std::to_string(collider) + "].node = '" + cleanUtf8(node) + "' ";
    return bodies == 0 ? invalidInput(named + "is the name of no body of " + quotedPath(scene.world) +
                                      "; take one that its \"bodies\" list as \"node\"")
                       : invalidInput(named + "is the name of " + std::to_string(bodies) + " bodies of " +
                                      quotedPath(scene.world) + "; give their nodes names of their own");
}

/// \param to  its keys are kept, and as much of its pose as it has.
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
    const BodiesOfNodes nodes = bodiesOfNodes(world);
    std::vector<bool> placed(world.bodies.size());
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        SceneCollider& collider = scene.colliders[i];
        if (collider.node.empty()) {
            continue;
        }
        const std::size_t body = RELIEF_TRY(bodyNamed(scene, nodes, i));
        if (placed[body]) {
            return invalidInput(scene.world_origin + ": collider[" + std::to_string(i) + "].node = '" +
                                cleanUtf8(collider.node) + "' is named by two colliders; remove one of them");
        }
        placed[body] = true;
        place(collider, world.bodies[body], scene, world);
    }
    for (std::size_t i = 0; i < world.bodies.size(); ++i) {
        if (!placed[i]) {
            place(scene.colliders.emplace_back(), world.bodies[i], scene, world);
        }
    }
    if (scene.colliders.size() > ColliderTextures::kBodiesMax) {
        return fail(ErrorCode::kLimit, scene.world_origin + ": the world's " +
                                           std::to_string(world.bodies.size()) +
                                           " bodies and the scene's other colliders are more than " +
                                           std::to_string(ColliderTextures::kBodiesMax) + "; leave some out");
    }
    return {};
}

}  // namespace relief
