// SPDX-License-Identifier: Apache-2.0
// Scene values with custom formats.
#include <algorithm>
#include <array>
#include <string>
#include <variant>
#include <vector>

#include "formats/config/toml_reader.h"
#include "formats/fields/json_value.h"
#include "runtime/scene/scene.h"

namespace relief {
namespace {

/// Reads a single value, or keys [age, value…].
template <class T>
void readTrack(const TomlValue& from, void* into, const FieldInfo& info) {
    auto& track = *static_cast<AgeTrack<T>*>(into);
    constexpr bool kColor = !std::is_same_v<T, float>;
    constexpr std::size_t kParts = kColor ? 3 : 1;
    constexpr std::string_view kWanted =
        kColor ? "[r, g, b], or keys [[age, r, g, b], …]" : "a number, or keys [[age, value], …]";
    const auto size = [](const TomlValue& value) {
        return value.array() == nullptr ? 0 : value.array()->size();
    };
    const auto numbers = [&](const TomlValue& list, std::size_t first) {
        const auto part = [&](std::size_t i) {
            return static_cast<float>(list[first + i].number(info.range));
        };
        if constexpr (kColor) {
            return glm::vec3{part(0), part(1), part(2)};  // in this order
        } else {
            return part(0);
        }
    };
    if (size(from) == 0 || from[0].array() == nullptr) {
        if constexpr (kColor) {
            if (size(from) != kParts) {
                from.wrongType(kWanted);
            }
            track = {{0.0F, numbers(from, 0)}};
        } else {
            if (!from.node().is_number()) {
                from.wrongType(kWanted);
            }
            track = {{0.0F, static_cast<float>(from.number(info.range))}};
        }
        return;
    }
    if (size(from) > kLookKeysMax) {
        from.fail(from.name() + " has " + std::to_string(size(from)) + " keys; the maximum is " +
                  std::to_string(kLookKeysMax));
    }
    for (std::size_t i = 0; i < size(from); ++i) {
        const TomlValue one = from[i];
        if (size(one) != kParts + 1) {
            one.wrongType(kWanted);
        }
        const auto age = static_cast<float>(one[0].number({0.0, 1.0}));
        if (!track.empty() && age <= track.back().age) {
            one[0].fail("the ages of " + from.name() + " are not ascending; sort its keys");
        }
        track.push_back({age, numbers(one, 1)});
    }
}

void readSpeed(const TomlValue& from, void* value, const FieldInfo& info) {
    EmitterAim& aim = static_cast<const EmitterSpeed*>(value)->aim;
    if (from.node().is_table()) {
        NormalSpeed normal;
        readToml(from, normal);
        aim.speed_min = normal.mean;
        aim.speed_max = normal.mean;
        aim.speed_deviation = normal.deviation;
        return;
    }
    readValue(from, FieldSpan{aim.speed_min, aim.speed_max}, info);
}

void readNames(const TomlValue& from, void* value, const FieldInfo& /*info*/) {
    const auto& [names, origins] = *static_cast<const NameList*>(value);
    names.clear();
    origins.clear();
    const std::size_t count = from.array() == nullptr ? 1 : from.array()->size();
    for (std::size_t i = 0; i < count; ++i) {
        const TomlValue one = from.array() == nullptr ? from : from[i];
        if (!one.node().is_string()) {
            one.wrongType("a name, or a list of names");
        }
        names.push_back(one.text());
        origins.push_back(one.place());
    }
    if (std::count(names.begin(), names.end(), "") > 0 || count == 0) {
        from.fail(from.name() + " must list at least one name, and no empty name");
    }
}

void readCollides(const TomlValue& from, void* value, const FieldInfo& /*info*/) {
    std::uint32_t& bits = static_cast<const CollidesList*>(value)->bits;
    constexpr std::string_view kWanted =
        "indices of colliders, and optionally \"ground\", as in [0, \"ground\"]";
    static constexpr std::array<std::string_view, 1> kGround{"ground"};
    if (from.array() == nullptr) {
        from.wrongType(kWanted);
    }
    const TomlValue top(*from.file().top, "", from.file());
    const auto ground = top.find("ground.enabled");
    const bool no_ground = ground && ground->node().value<bool>() == false;
    std::size_t colliders = 0;
    while (top.find("collider[" + std::to_string(colliders) + "]")) {
        ++colliders;
    }
    if (top.find("world")) {
        colliders = WorldTextures::kBodiesMax;  // the number of its bodies is not known yet
    }
    bits = 0;
    for (std::size_t i = 0; i < from.array()->size(); ++i) {
        const TomlValue one = from[i];
        if (one.node().is_integer()) {
            const std::int64_t body = one.whole({0.0, static_cast<double>(colliders) - 1.0});
            bits |= 1U << std::min<std::int64_t>(body, WorldTextures::kGroups - 1);
            continue;
        }
        if (!one.node().is_string()) {
            one.wrongType(kWanted);
        }
        static_cast<void>(one.word(kGround));
        if (no_ground) {
            one.fail(from.name() +
                     " names the ground, which ground.enabled = false disables; remove one of them");
        }
        bits |= kCollidesWithGround;
    }
}

/// Returns the numbers of a key: [age, value].
std::array<float, 2> partsOf(const AgeKey<float>& key) {
    return {key.age, key.value};
}
std::array<float, 4> partsOf(const AgeKey<glm::vec3>& key) {
    return {key.age, key.value.x, key.value.y, key.value.z};
}

template <class T>
void keyJson(const void* value, FieldJson& json) {
    json.json = jsonOf(partsOf(*static_cast<const AgeKey<T>*>(value)));
}
template <class T>
void keySchema(FieldJson& schema) {
    schema.json = schemaOf(partsOf(AgeKey<T>{}));
}

void speedJson(const void* value, FieldJson& json) {
    const EmitterAim& aim = static_cast<const EmitterSpeed*>(value)->aim;
    json.json = aim.speed_deviation > 0.0F ? jsonOf(NormalSpeed{aim.speed_min, aim.speed_deviation})
                                           : jsonOf(std::array{aim.speed_min, aim.speed_max});
}
void speedSchema(FieldJson& schema) {
    schema.json = schemaOf(std::variant<std::array<float, 2>, NormalSpeed>{});
}
void namesJson(const void* value, FieldJson& json) {
    json.json = jsonOf(static_cast<const NameList*>(value)->names);
}
void namesSchema(FieldJson& schema) {
    schema.json = arraySchema(textSchema({}), kFromOne);
}
void collidesJson(const void* value, FieldJson& json) {
    const std::uint32_t bits = static_cast<const CollidesList*>(value)->bits;
    json.json = Json::array();
    for (std::uint32_t i = 0; i < kGroundBit; ++i) {
        if ((bits >> i & 1U) != 0) {
            json.json.push_back(i);
        }
    }
    if ((bits & kCollidesWithGround) != 0) {
        json.json.push_back("ground");
    }
}
void collidesSchema(FieldJson& schema) {
    const Json number = {{"type", "integer"}, {"minimum", 0}};
    schema.json = arraySchema({{"anyOf", {number, {{"enum", {"ground"}}}}}}, kFromZero);
}
}  // namespace

const FieldCustom kNumberTrackField{.read = readTrack<float>};
const FieldCustom kColorTrackField{.read = readTrack<glm::vec3>};
const FieldCustom kNumberKeyField{.json = keyJson<float>, .schema = keySchema<float>};
const FieldCustom kColorKeyField{.json = keyJson<glm::vec3>, .schema = keySchema<glm::vec3>};
const FieldCustom kEmitterSpeedField{readSpeed, speedJson, speedSchema};
const FieldCustom kNameListField{readNames, namesJson, namesSchema};
const FieldCustom kCollidesListField{readCollides, collidesJson, collidesSchema};

}  // namespace relief
