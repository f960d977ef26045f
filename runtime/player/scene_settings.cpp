#include "runtime/player/scene_settings.h"

namespace relief {

std::vector<ColliderTable> ColliderTable::kinds() {
    static const SceneCollider live = [] {
        SceneCollider collider;
        collider.live.emplace();
        return collider;
    }();
    return {{}, {live}};
}

std::optional<std::variant<std::array<float, 2>, NormalSpeed>> EmitterTable::speed() const {
    using Speed = std::variant<std::array<float, 2>, NormalSpeed>;
    if (!emitter.aim) {
        return std::nullopt;
    }
    const EmitterAim& aim = *emitter.aim;
    return aim.speed_deviation > 0.0F ? Speed(NormalSpeed{aim.speed_min, aim.speed_deviation})
                                      : Speed(std::array{aim.speed_min, aim.speed_max});
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

std::vector<TypeTable> SceneSettings::types() const {
    std::vector<TypeTable> all;
    for (const SceneType& type : scene.types) {
        all.push_back({scene, type});
    }
    return all;
}

}  // namespace relief
