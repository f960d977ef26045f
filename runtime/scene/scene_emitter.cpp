// SPDX-License-Identifier: Apache-2.0
#include "runtime/scene/scene_emitter.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

/// Returns the seconds during which an emitter is active.
double activeSeconds(const SceneEmitter& emitter, double run) {
    return std::min(std::max(run - emitter.start, 0.0), emitter.duration);
}

double burstBirths(const SceneEmitter& emitter, double seconds) {
    const double again = emitter.burst_every > 0.0 ? std::floor(seconds / emitter.burst_every) : 0.0;
    return static_cast<double>(emitter.burst) * (1.0 + again);
}

/// Distributes the remaining capacity over emitters without a rate, so that it is used up at the end of the run.
Result<void> distributeRates(std::span<SceneEmitter> emitters, double run, std::uint32_t capacity) {
    double room = capacity;
    double sharing = 0.0;
    for (const SceneEmitter& emitter : emitters) {
        const double seconds = activeSeconds(emitter, run);
        room -= burstBirths(emitter, seconds) + (emitter.has_rate ? emitter.rate : 0.0) * seconds;
        sharing += emitter.has_rate ? 0.0 : 1.0;
    }
    const double share = std::max(room, 0.0) / std::max(sharing, 1.0);
    for (SceneEmitter& emitter : emitters) {
        if (emitter.has_rate) {
            continue;
        }
        const double seconds = activeSeconds(emitter, run);
        emitter.rate = seconds > 0.0 ? std::min(share / seconds, kRateMax) : 0.0;
        emitter.has_rate = true;
        if (seconds > 0.0 && emitter.rate == 0.0 && emitter.burst == 0) {
            return invalidInput(
                "other emitters use up the capacity, so an emitter without a rate would emit nothing; "
                "set its emitter.rate, or raise particles.capacity");
        }
    }
    return {};
}

/// Checks the place of births.
std::optional<FieldFault> checkPlace(SceneEmitter& emitter, const GivenFields& given) {
    if (emitter.shape == EmitterShape::kPoint) {
        emitter.shape = EmitterShape::kBox;
        emitter.box_max = emitter.box_min;
        emitter.has_box = true;
    }
    for (int i = 0; i < 3; ++i) {
        if (emitter.box_min[i] > emitter.box_max[i]) {
            return FieldFault{"box_min", "is above emitter.box_max on the " + std::string(1, "xyz"[i]) +
                                             " axis; swap them"};
        }
    }
    if (given("attach") && emitter.shape == EmitterShape::kBox && !emitter.has_box) {
        return FieldFault{"attach",
                          "needs a position in the space of the collider; add emitter.point, for example"};
    }
    if (emitter.followsShape() && !given("attach")) {
        return FieldFault{
            "shape",
            "= \"surface\" needs emitter.attach with the index of a collider, or emitter.mesh; add one"};
    }
    if (emitter.followsShape() && given("key")) {
        return FieldFault{"key",
                          "cannot move a collider's surface, which follows the collider; remove the keys, or "
                          "set emitter.mesh"};
    }
    for (const auto& [key, name] : {std::pair("group", &emitter.group), {"material", &emitter.material}}) {
        if (given(key) && name->empty()) {
            return FieldFault{key, "is empty; set a name, or remove it"};
        }
    }
    return std::nullopt;
}

}  // namespace

SceneEmitter::SceneEmitter() {
    lifetime_min = 30.0F;
    lifetime_max = 30.0F;
}

std::optional<FieldFault> check(SceneEmitter& emitter, const GivenFields& given) {
    if (auto fault = checkPlace(emitter, given)) {
        return fault;
    }
    if (emitter.has_rate && emitter.rate == 0.0 && emitter.burst == 0) {
        return FieldFault{given("burst") ? "burst" : "rate",
                          "emits no particles; set emitter.rate or emitter.burst above 0"};
    }
    const char* const by = given("direction") ? "direction" : given("cone") ? "cone" : "speed";
    emitter.has_aim = emitter.has_aim || emitter.has_speed;
    if (!emitter.has_aim) {
        emitter.aim.reset();
    } else if (!emitter.aim->direction && emitter.shape == EmitterShape::kBox) {
        return FieldFault{by, "needs emitter.direction, because a box or point has no normal; add it"};
    }
    emitter.keys = completeKeys(emitter.given_keys, {});
    return checkKeys(emitter.given_keys, "emitter.point");
}

std::optional<FieldFault> check(SceneSpawn& spawn, const GivenFields& given) {
    if (!given("cone")) {
        spawn.cone_degrees = spawn.on == SpawnOn::kCollision ? 60.0F : 180.0F;
    }
    return std::nullopt;
}

Result<void> completeEmitters(std::span<SceneEmitter> emitters, const Bounds& bounds, float scale,
                              double seconds, std::uint32_t capacity) {
    const glm::vec3 center = bounds.center();
    const float aside = 1.45F * scale;
    for (SceneEmitter& emitter : emitters) {
        if (emitter.shape == EmitterShape::kBox && !emitter.has_box) {
            emitter.box_min = glm::vec3(center.x - aside, bounds.max.y + 0.15F * scale, center.z - aside);
            emitter.box_max = glm::vec3(center.x + aside, bounds.max.y + 0.75F * scale, center.z + aside);
        }
        if (emitter.aim && !emitter.has_speed) {
            emitter.aim->speed_min = 0.8F * scale;
            emitter.aim->speed_max = emitter.aim->speed_min;
            emitter.has_speed = true;
        }
        if (!emitter.aim && !emitter.has_velocity) {
            emitter.velocity = glm::vec3(0.0F, -0.8F * scale, 0.0F);
            emitter.has_velocity = true;
        }
        if (!emitter.aim && !emitter.has_velocity_spread) {
            emitter.velocity_spread = glm::vec3(0.12F * scale, 0.1F * scale, 0.12F * scale);
        }
    }
    return distributeRates(emitters, seconds, capacity);
}

std::vector<Spawner> makeSpawners(std::span<const SceneSpawn> spawns,
                                  std::span<const std::string> materials) {
    std::vector<Spawner> made;
    for (const SceneSpawn& spawn : spawns) {
        SpawnSettings settings = spawn;
        if (!spawn.on_material.empty()) {
            settings.material = static_cast<int>(
                std::find(materials.begin(), materials.end(), spawn.on_material) - materials.begin());
        }
        made.emplace_back(settings, spawn.seed, kEmittersMax + made.size());
    }
    return made;
}

std::vector<EmitterMotion> emitterMotions(std::span<const SceneEmitter> emitters,
                                          std::span<const SceneCollider> colliders) {
    std::vector<EmitterMotion> motions;
    for (const SceneEmitter& emitter : emitters) {
        EmitterMotion& motion = motions.emplace_back();
        motion.keys = emitter.keys;
        motion.inherit = emitter.inherit;
        if (emitter.attach) {
            const SceneCollider& body = colliders[*emitter.attach];
            motion.body = body.keys.empty() ? std::vector<PoseKey>{{0.0, body.pose}} : body.keys;
        }
    }
    return motions;
}

}  // namespace relief
