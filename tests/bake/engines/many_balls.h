// SPDX-License-Identifier: Apache-2.0
// A level of 300 rotated and scaled bodies of two ball colliders, and its exported files.
#pragma once

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "bake/engines/engine_export.h"
#include "tests/bake/meshes.h"
#include "tests/results.h"

namespace relief::test {

inline Collider ball() {
    return bakeSpecs(makeIcosphere({0.2, 0.1, -0.3}, 0.9, 3), {"patches:budget=20kB"});
}

inline LoadedWorld manyBalls() {
    LoadedWorld level;
    level.colliders = {ball(), bakeSpecs(makeIcosphere({0.0, 0.0, 0.0}, 0.4, 2), {"patches:budget=4kB"})};
    for (const Collider& collider : level.colliders) {
        WorldCollider listed;
        listed.box = collider.bounds;
        level.world.colliders.push_back(listed);
    }
    std::mt19937 random(2);
    std::uniform_real_distribution<float> place(-12.0F, 12.0F);
    std::uniform_real_distribution<float> part(-1.0F, 1.0F);
    for (std::uint32_t i = 0; i < 300; ++i) {
        const glm::quat turn =
            glm::normalize(glm::quat(part(random), part(random), part(random), part(random)));
        level.world.bodies.push_back({.collider = i % 2,
                                      .position = {place(random), place(random), 0.5F * place(random)},
                                      .rotation = {turn.x, turn.y, turn.z, turn.w},
                                      .scale = 1.0F + 0.5F * part(random)});
    }
    return level;
}

inline std::vector<glm::vec3> pointsAmongBalls(std::size_t count) {
    std::mt19937 random(4);
    std::uniform_real_distribution<float> place(-13.0F, 13.0F);
    std::vector<glm::vec3> points(count);
    for (glm::vec3& p : points) {
        p = {place(random), place(random), 0.5F * place(random)};
    }
    return points;
}

/// Returns the signed distance of the body that contains p most deeply, or kFarOutside if none contains p.
inline float depthIn(const LoadedWorld& level, const glm::vec3& p) {
    float deepest = kFarOutside;
    for (const WorldBody& body : level.world.bodies) {
        const Pose pose = poseOf(body);
        const FieldSample field = evaluate(level.colliders[body.collider], toObject(pose, p));
        deepest = std::min(deepest, field.inside() ? pose.scale * field.distance : kFarOutside);
    }
    return deepest;
}

/// Returns the exact distance of the nearest ball, negative inside; ignores that the balls are faceted.
inline float distanceToBalls(const LoadedWorld& level, const glm::vec3& p) {
    float gap = kFarOutside;
    for (const WorldBody& body : level.world.bodies) {
        const Pose pose = poseOf(body);
        const bool small = body.collider == 1;
        const glm::vec3 center = toWorld(pose, small ? glm::vec3(0.0F) : glm::vec3(0.2F, 0.1F, -0.3F));
        gap = std::min(gap, glm::distance(p, center) - pose.scale * (small ? 0.4F : 0.9F));
    }
    return gap;
}

inline const EngineFile& fileNamed(const std::vector<EngineFile>& files, const std::string& name) {
    const auto found = std::ranges::find(files, name, &EngineFile::name);
    EXPECT_NE(found, files.end()) << name;
    return *found;
}

}  // namespace relief::test
