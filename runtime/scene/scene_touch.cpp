// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_touch.h"
#include "runtime/births/emitter_motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <map>

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
            bodies_.push_back({i, grown(box, kRoom * box.longestSide())});
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
                 [&](const Body& body) { return grown(body.box, touching_.within).meets(all); });
    const bool all_rest = std::all_of(near.begin(), near.end(), [&](const Body& body) {
        return loaded_->scene.colliders[body.index].keys.empty();
    });
    // Most births are far from everything. Among bodies at rest, one search finds this for a whole cell of a grid.
    const float cell = 2.0F * touching_.within;
    const float reach = touching_.within + std::sqrt(0.75F) * cell;
    std::map<std::array<float, 3>, bool> cells;
    const auto mayTouch = [&](const glm::vec3& p) {
        const glm::vec3 low = glm::floor(p / cell);
        const auto [at, is_new] = cells.try_emplace({low.x, low.y, low.z});
        if (is_new) {
            at->second = nearest(cell * (low + 0.5F), time, near, reach).has_value();
        }
        return at->second;
    };
    std::vector<bool> touching;
    for (std::size_t i = 0; i < births.size(); ++i) {
        const glm::vec3& p = births[i].position;
        const double moment = time - static_cast<double>(births[i].age);
        const bool hopeless = all_rest && (glm::length(velocities[i]) < touching_.min_speed || !mayTouch(p));
        touching.push_back(!hopeless && touches(p, velocities[i], moment, near));
    }
    return touching;
}

std::optional<TouchFilter::Touched> TouchFilter::touchedOf(const Body& body, const glm::vec3& p,
                                                           double moment, float within) const {
    if (!grown(body.box, within).contains(p)) {
        return std::nullopt;
    }
    const SceneCollider& placed = loaded_->scene.colliders[body.index];
    const Collider& shape = *loaded_->colliders[body.index];
    const Pose pose = poseAt(placed, moment);
    const glm::vec3 q = toObject(pose, p);
    const float reach = within / pose.scale;
    if (!grown(shape.bounds, reach).contains(q)) {
        return std::nullopt;
    }
    const SurfaceSample at = nearestSurface(shape, q, reach);
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

std::optional<TouchFilter::Touched> TouchFilter::nearest(const glm::vec3& p, double moment,
                                                         std::span<const Body> near, float within) const {
    std::optional<Touched> nearest;
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
    return nearest;
}

bool TouchFilter::touches(const glm::vec3& p, const glm::vec3& velocity, double moment,
                          std::span<const Body> near) const {
    const std::optional<Touched> touched = nearest(p, moment, near, touching_.within);
    const std::vector<std::string>& names = touching_.materials;
    return touched &&
           (names.empty() || std::find(names.begin(), names.end(), touched->material) != names.end()) &&
           glm::length(velocity - touched->velocity) >= touching_.min_speed;
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
