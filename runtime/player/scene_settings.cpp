#include "runtime/player/scene_settings.h"

namespace relief {

std::vector<ColliderTable> ColliderTable::kinds() {
    static const SceneCollider live{.path = {}, .origin = {}, .pose = {}, .live = SceneLive{}, .keys = {}};
    return {{}, {live}};
}

std::optional<std::variant<std::array<float, 2>, SpeedLaw>> EmitterTable::speed() const {
    using Speed = std::variant<std::array<float, 2>, SpeedLaw>;
    if (!emitter.aimed) {
        return std::nullopt;
    }
    const float least = *emitter.speed_min;
    return emitter.speed_deviation > 0.0F ? Speed(SpeedLaw{least, emitter.speed_deviation})
                                          : Speed(std::array{least, *emitter.speed_max});
}

std::vector<std::variant<std::size_t, GroundWord>> TypeTable::collides() const {
    std::vector<std::variant<std::size_t, GroundWord>> bodies;
    for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
        if ((type.collides >> i & 1U) != 0) {
            bodies.emplace_back(i);
        }
    }
    if (scene.ground.enabled && (type.collides & kCollidesWithGround) != 0) {
        bodies.emplace_back(GroundWord::kGround);
    }
    return bodies;
}

std::vector<std::array<float, 2>> keysOf(const AgeTrack<float>& track) {
    std::vector<std::array<float, 2>> keys;
    for (const AgeKey<float>& key : track) {
        keys.push_back({key.age, key.value});
    }
    return keys;
}

std::vector<std::array<float, 4>> keysOf(const AgeTrack<glm::vec3>& track) {
    std::vector<std::array<float, 4>> keys;
    for (const AgeKey<glm::vec3>& key : track) {
        keys.push_back({key.age, key.value.x, key.value.y, key.value.z});
    }
    return keys;
}

std::vector<TypeTable> SceneSettings::types() const {
    std::vector<TypeTable> all;
    for (std::size_t i = 0; i < scene.render.looks.size(); ++i) {
        all.push_back({scene, scene.types[i], scene.render.looks[i], scene.type_names[i]});
    }
    return all;
}

}  // namespace relief
