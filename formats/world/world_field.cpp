#include "formats/world/world_field.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace relief {
namespace {

/// Room round the box of a body, in units of its largest coordinate: an error of rotating in floats is a tenth of that.
constexpr float kRoom = 1e-5F;

glm::quat rotationOf(const WorldBody& body) {
    return {body.rotation[3], body.rotation[0], body.rotation[1], body.rotation[2]};
}

}  // namespace

WorldField::WorldField(LoadedWorld loaded) : loaded_(std::move(loaded)) {
    for (std::size_t i = 0; i < world().bodies.size(); ++i) {
        const WorldBody& body = world().bodies[i];
        const Bounds& box = colliderOf(i).bounds;
        Bounds placed;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 at{corner & 1 ? box.max.x : box.min.x, corner & 2 ? box.max.y : box.min.y,
                               corner & 4 ? box.max.z : box.min.z};
            placed.add(body.position + turn(i, at));
        }
        float largest = 0.0F;
        for (int axis = 0; axis < 3; ++axis) {
            largest = std::max({largest, std::abs(placed.min[axis]), std::abs(placed.max[axis])});
        }
        placed.min -= glm::vec3(kRoom * largest);
        placed.max += glm::vec3(kRoom * largest);
        boxes_.push_back(placed);
    }
}

template <class Holds>
WorldSample WorldField::least(const glm::vec3& p, const Holds& holds) const {
    WorldSample best;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
        if (!holds(boxes_[i])) {
            continue;
        }
        const FieldSample sample = relief::evaluate(colliderOf(i), toObject(i, p));
        const float distance =
            sample.distance >= kFarOutside ? kFarOutside : world().bodies[i].scale * sample.distance;
        if (sample.map >= 0 && (best.body < 0 || distance < best.distance)) {
            best = {distance, rotationOf(world().bodies[i]) * sample.normal, static_cast<int>(i)};
        }
    }
    return best;
}

WorldSample WorldField::evaluate(const glm::vec3& p) const {
    return least(p, [](const Bounds&) { return true; });
}

WorldSample WorldField::deepest(const glm::vec3& p) const {
    return least(p, [&p](const Bounds& box) {
        return p.x >= box.min.x && p.x <= box.max.x && p.y >= box.min.y && p.y <= box.max.y &&
               p.z >= box.min.z && p.z <= box.max.z;
    });
}

glm::vec3 WorldField::toObject(std::size_t body, const glm::vec3& p) const {
    const WorldBody& placed = world().bodies[body];
    return (glm::conjugate(rotationOf(placed)) * (p - placed.position)) / placed.scale;
}

glm::vec3 WorldField::turn(std::size_t body, const glm::vec3& v) const {
    return world().bodies[body].scale * (rotationOf(world().bodies[body]) * v);
}

}  // namespace relief
