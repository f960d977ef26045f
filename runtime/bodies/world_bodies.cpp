// SPDX-License-Identifier: Apache-2.0
#include "runtime/bodies/world_bodies.h"

namespace relief {

std::vector<ColliderBody> worldBodies(const LoadedWorld& world) {
    std::vector<ColliderBody> bodies;
    bodies.reserve(world.world.bodies.size());
    for (const WorldBody& body : world.world.bodies) {
        bodies.push_back({&world.colliders[body.collider], poseOf(body), body.restitution, body.friction});
    }
    return bodies;
}

std::vector<Pose> worldPoses(const World& world) {
    std::vector<Pose> poses;
    poses.reserve(world.bodies.size());
    for (const WorldBody& body : world.bodies) {
        poses.push_back(poseOf(body));
    }
    return poses;
}

}  // namespace relief
