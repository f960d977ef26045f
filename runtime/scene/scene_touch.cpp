// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_touch.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "formats/nearest_surface.h"

namespace relief {
namespace {

/// Margin for the error of worldBounds(), 1/1000 of the body's radius, and for rounding.
constexpr float kRoom = 0.002F;

Bounds grown(const Bounds& box, float room) {
    return {box.min - room, box.max + room};
}

/// Returns the collider that names the node of a tile; for other colliders, the collider itself.
std::size_t wholeOf(const Scene& scene, std::size_t collider) {
    return scene.colliders[collider].tile_of.value_or(collider);
}

}  // namespace

TouchFilter::TouchFilter(const LoadedScene& loaded, const SceneEmitter& emitter)
    : loaded_(&loaded), touching_(*emitter.touching) {
    const Scene& scene = loaded.scene;
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        const SceneCollider& body = scene.colliders[i];
        const bool own = emitter.attach && wholeOf(scene, *emitter.attach) == wholeOf(scene, i);
        if (!own && !body.deforms()) {
            const Bounds box = worldBounds(body, loaded.colliders[i]->bounds);
            bodies_.push_back({i, grown(box, touching_.within + kRoom * box.longestSide())});
        }
    }
}

std::vector<bool> TouchFilter::operator()(std::span<const Birth> births,
                                          std::span<const glm::vec3> velocities, double time) const {
    Bounds all;
    for (const Birth& birth : births) {
        all.add(birth.position);
    }
    std::vector<Body> near;
    std::copy_if(bodies_.begin(), bodies_.end(), std::back_inserter(near),
                 [&](const Body& body) { return body.box.meets(all); });
    const bool all_rest = std::all_of(near.begin(), near.end(), [&](const Body& body) {
        return loaded_->scene.colliders[body.index].keys.empty();
    });
    std::vector<bool> touching;
    for (std::size_t i = 0; i < births.size(); ++i) {
        const double moment = time - static_cast<double>(births[i].age);
        const bool too_slow = all_rest && glm::length(velocities[i]) < touching_.min_speed;
        touching.push_back(!too_slow && touches(births[i].position, velocities[i], moment, near));
    }
    return touching;
}

std::optional<TouchFilter::Touched> TouchFilter::touchedOf(const Body& body, const glm::vec3& p,
                                                           double moment, float within) const {
    if (!body.box.contains(p)) {
        return std::nullopt;
    }
    const SceneCollider& placed = loaded_->scene.colliders[body.index];
    const Collider& shape = *loaded_->colliders[body.index];
    const Pose pose = poseAt(placed, moment);
    const glm::vec3 q = toObject(pose, p);
    const float reach = within / pose.scale;
    if (!grown(shape.bounds, reach).contains(q) || !mayBeInside(shape, boxToSearch(shape, q, reach))) {
        return std::nullopt;
    }
    const SurfaceSample at = nearestSurface(shape, q);
    const float distance = pose.scale * std::abs(at.distance);
    if (at.map < 0 || !(distance < within)) {
        return std::nullopt;
    }
    const Materials& materials = shape.materials;
    const Motion motion = placed.keys.empty() ? Motion{} : motionAt(placed.keys, moment);
    return Touched{
        distance,
        materials.empty() ? std::string() : materials.list[materialAt(materials, at.point, at.normal)].name,
        motion.velocity + glm::cross(motion.turn, p - pose.position)};
}

bool TouchFilter::touches(const glm::vec3& p, const glm::vec3& velocity, double moment,
                          std::span<const Body> near) const {
    std::optional<Touched> nearest;
    float within = touching_.within;
    const auto offer = [&](const std::optional<Touched>& one) {
        if (one && one->distance < within) {
            within = one->distance;
            nearest = one;
        }
    };
    for (const Body& body : near) {
        offer(touchedOf(body, p, moment, within));
    }
    const SceneGround& ground = loaded_->scene.ground;
    if (ground.enabled && ground.height) {
        offer(Touched{std::abs(p.y - *ground.height), {}, glm::vec3(0.0F)});
    }
    const std::vector<std::string>& names = touching_.materials;
    return nearest &&
           (names.empty() || std::find(names.begin(), names.end(), nearest->material) != names.end()) &&
           glm::length(velocity - nearest->velocity) >= touching_.min_speed;
}

std::vector<EmitterMotion> emitterMotions(const LoadedScene& loaded) {
    std::vector<EmitterMotion> motions = emitterMotions(loaded.scene.emitters, loaded.scene.colliders);
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const SceneEmitter& emitter = loaded.scene.emitters[i];
        if (emitter.touching) {
            motions[i].filter = TouchFilter(loaded, emitter);
        }
    }
    return motions;
}

}  // namespace relief
