#include "runtime/scene/scene_collider.h"

#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <span>

namespace relief {

Pose completePose(ScenePose& pose, const Pose& rest) {
    Pose result = rest;
    result.position = pose.position.value_or(rest.position);
    if (pose.angle) {
        // After two turns the quaternion is the same; a small angle is exact to more digits.
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
            return FieldFault{"key[" + std::to_string(i) + "].time", "does not rise; order the keys by time"};
        }
    }
    if (keys.size() == 1) {
        return FieldFault{"key", std::string("alone moves nothing; give a second, or ") + instead};
    }
    return std::nullopt;
}

std::optional<FieldFault> check(SceneCollider& collider, const GivenFields& given) {
    if (given("mesh") && !collider.live) {
        return FieldFault{
            "mesh", "needs collider.deform; for a mesh at rest give collider.file, baked with 'relief bake'"};
    }
    if (collider.path.empty()) {
        return FieldFault{
            "", "needs collider.file, the .relief file to collide with; bake one with 'relief bake'"};
    }
    ScenePose pose = collider.given_pose;
    collider.posed = collider.posed || pose.position || pose.angle || given("key");
    collider.pose = completePose(pose, {.scale = collider.scale});
    collider.given_pose = collider.posed ? pose : ScenePose{};
    collider.keys = completeKeys(collider.given_keys, collider.pose);
    return checkKeys(collider.given_keys, "a position");
}

Pose poseAt(const SceneCollider& collider, double time) {
    return collider.keys.empty() ? collider.pose : poseAt(std::span<const PoseKey>(collider.keys), time);
}

Bounds worldBounds(const SceneCollider& collider, const Bounds& object) {
    // A turn between two keys is cut finely enough to be off by no more than a thousandth of its radius.
    constexpr int kCuts = 64;
    Bounds world{glm::vec3(std::numeric_limits<float>::max()),
                 glm::vec3(std::numeric_limits<float>::lowest())};
    const auto add = [&](const Pose& pose) {
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 p((corner & 1) != 0 ? object.max.x : object.min.x,
                              (corner & 2) != 0 ? object.max.y : object.min.y,
                              (corner & 4) != 0 ? object.max.z : object.min.z);
            const glm::vec3 q = toWorld(pose, p);
            world.min = glm::min(world.min, q);
            world.max = glm::max(world.max, q);
        }
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
