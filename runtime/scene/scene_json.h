// A scene as JSON: values of a scene that formats/fields/json.h does not know.
#pragma once

#include <array>
#include <variant>
#include <vector>

#include "formats/fields/json.h"
#include "runtime/scene/scene.h"

namespace relief {

/// A key of a track: [age, value].
inline std::array<float, 2> partsOf(const AgeKey<float>& key) {
    return {key.age, key.value};
}
inline std::array<float, 4> partsOf(const AgeKey<glm::vec3>& key) {
    return {key.age, key.value.x, key.value.y, key.value.z};
}
template <class T>
[[nodiscard]] Json jsonField(const AgeKey<T>& key) {
    return jsonOf(partsOf(key));
}
template <class T>
[[nodiscard]] Json schemaField(const AgeKey<T>& key) {
    return schemaOf(partsOf(key));
}

template <class Aim>
[[nodiscard]] Json jsonField(const EmitterSpeed<Aim>& speed) {
    const EmitterAim& aim = speed.aim;
    return aim.speed_deviation > 0.0F ? jsonOf(NormalSpeed{aim.speed_min, aim.speed_deviation})
                                      : jsonOf(std::array{aim.speed_min, aim.speed_max});
}
template <class Aim>
[[nodiscard]] Json schemaField(const EmitterSpeed<Aim>& /*speed*/) {
    return schemaOf(std::variant<std::array<float, 2>, NormalSpeed>{});
}

template <class Names>
[[nodiscard]] Json jsonField(const NameList<Names>& list) {
    return jsonOf(list.names);
}
template <class Names>
[[nodiscard]] Json schemaField(const NameList<Names>& /*list*/) {
    return arraySchema(textSchema({}), kFromOne);
}

template <class Bits>
[[nodiscard]] Json jsonField(const CollidesList<Bits>& list) {
    Json bodies = Json::array();
    for (std::uint32_t i = 0; i < kGroundBit; ++i) {
        if ((list.bits >> i & 1U) != 0) {
            bodies.push_back(i);
        }
    }
    if ((list.bits & kCollidesWithGround) != 0) {
        bodies.push_back("ground");
    }
    return bodies;
}
template <class Bits>
[[nodiscard]] Json schemaField(const CollidesList<Bits>& /*list*/) {
    const Json number = {{"type", "integer"}, {"minimum", 0}};
    return arraySchema({{"anyOf", {number, {{"enum", {"ground"}}}}}}, kFromZero);
}

}  // namespace relief
