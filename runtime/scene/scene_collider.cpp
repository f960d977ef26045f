#include "runtime/scene/scene_collider.h"

#include <limits>
#include <span>

namespace relief {

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
