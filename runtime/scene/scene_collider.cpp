// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_collider.h"

#include <cmath>
#include <glm/glm.hpp>
#include <span>

namespace relief {

Pose completePose(ScenePose& pose, const Pose& rest) {
    Pose result = rest;
    result.position = pose.position.value_or(rest.position);
    if (pose.angle) {
        // Quaternions repeat after two turns; smaller angles are more precise.
        result.rotation = glm::normalize(glm::angleAxis(glm::radians(std::fmod(*pose.angle, 720.0F)),
                                                        pose.axis.value_or(glm::vec3(0.0F, 1.0F, 0.0F))));
    }
    pose = {result.position, glm::axis(result.rotation), glm::degrees(glm::angle(result.rotation))};
    return result;
}

std::vector<PoseKey> completeKeys(std::vector<SceneKey>& keys, const Pose& rest) {
    std::vector<PoseKey> result;
    for (SceneKey& key : keys) {
        result.push_back({key.time, completePose(key, rest)});
    }
    return result;
}

std::optional<FieldFault> checkKeys(const std::vector<SceneKey>& keys, const char* instead) {
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (!(keys[i].time > keys[i - 1].time)) {
            return FieldFault{"key[" + std::to_string(i) + "].time",
                              "is not ascending; sort the keys by time"};
        }
    }
    if (keys.size() == 1) {
        return FieldFault{"key", std::string("needs at least two entries; add one, or use ") + instead};
    }
    return std::nullopt;
}

std::optional<FieldFault> check(SceneCollider& collider, const GivenFields& given) {
    if (given("mesh") && !collider.live) {
        return FieldFault{
            "mesh", "needs collider.deform; for a rigid mesh, use collider.file, baked with 'relief bake'"};
    }
    if (given("node")) {
        if (collider.node.empty()) {
            return FieldFault{"node", "is empty; set a node of the world"};
        }
        for (const char* key : {"scale", "restitution", "friction"}) {
            if (given(key)) {
                return FieldFault{key, "is defined by the world; remove it here"};
            }
        }
        collider.posed = true;
        return checkKeys(collider.given_keys, "a position");
    }
    if (collider.path.empty()) {
        return FieldFault{
            "", "needs collider.file, the .relief file to collide with; bake one with 'relief bake'"};
    }
    collider.posed =
        collider.posed || collider.given_pose.position || collider.given_pose.angle || given("key");
    completePoses(collider, {.scale = collider.scale});
    return checkKeys(collider.given_keys, "a position");
}

void completePoses(SceneCollider& collider, const Pose& rest) {
    ScenePose pose = collider.given_pose;
    collider.pose = completePose(pose, rest);
    collider.given_pose = collider.posed ? pose : ScenePose{};
    collider.keys = completeKeys(collider.given_keys, collider.pose);
}

Pose poseAt(const SceneCollider& collider, double time) {
    return collider.keys.empty() ? collider.pose : poseAt(std::span<const PoseKey>(collider.keys), time);
}

Bounds worldBounds(const SceneCollider& collider, const Bounds& object) {
    // With this subdivision, the error of a turn between two keys is at most 1/1000 of its radius.
    constexpr int kCuts = 64;
    Bounds world;
    const auto add = [&](const Pose& pose) {
        const Bounds box = toWorld(pose, object);
        world.add(box.min);
        world.add(box.max);
    };
    add(poseAt(collider, 0.0));
    for (std::size_t i = 0; i + 1 < collider.keys.size(); ++i) {
        const double span = collider.keys[i + 1].time - collider.keys[i].time;
        for (int cut = 0; cut <= kCuts; ++cut) {
            add(poseAt(collider, collider.keys[i].time + span * cut / kCuts));
        }
    }
    return world;
}

}  // namespace relief
