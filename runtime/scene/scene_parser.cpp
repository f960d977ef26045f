#include "runtime/scene/scene_parser.h"

#include <algorithm>
#include <array>

#include "formats/base/file_io.h"
#include "formats/config/toml_reader.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSceneBytesMax = std::uint64_t{1} << 20;

}  // namespace

/// One value, or keys [age, value…].
template <class T>
void readField(const TomlValue& from, std::vector<AgeKey<T>>& track, const FieldInfo& info) {
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
        from.fail(from.name() + " has " + std::to_string(size(from)) + " keys; give " +
                  std::to_string(kLookKeysMax) + " at most");
    }
    for (std::size_t i = 0; i < size(from); ++i) {
        const TomlValue one = from[i];
        if (size(one) != kParts + 1) {
            one.wrongType(kWanted);
        }
        const auto age = static_cast<float>(one[0].number({0.0, 1.0}));
        if (!track.empty() && age <= track.back().age) {
            one[0].fail("the ages of " + from.name() + " do not rise; sort its keys");
        }
        track.push_back({age, numbers(one, 1)});
    }
}

void readField(const TomlValue& from, EmitterSpeed<EmitterAim> speed, const FieldInfo& info) {
    if (from.node().is_table()) {
        NormalSpeed normal;
        readToml(from, normal);
        speed.aim.speed_min = normal.mean;
        speed.aim.speed_max = normal.mean;
        speed.aim.speed_deviation = normal.deviation;
        return;
    }
    readValue(from, FieldSpan{speed.aim.speed_min, speed.aim.speed_max}, info);
}

void readField(const TomlValue& from, NameList<std::vector<std::string>> list, const FieldInfo& /*info*/) {
    list.names.clear();
    const std::size_t count = from.array() == nullptr ? 1 : from.array()->size();
    for (std::size_t i = 0; i < count; ++i) {
        const TomlValue one = from.array() == nullptr ? from : from[i];
        if (!one.node().is_string()) {
            one.wrongType("a name, or a list of names");
        }
        list.names.push_back(one.text());
    }
    if (std::count(list.names.begin(), list.names.end(), "") > 0 || count == 0) {
        from.fail(from.name() + " has no name, or an empty one; give one, or remove it");
    }
}

void readField(const TomlValue& from, CollidesList<std::uint32_t> list, const FieldInfo& /*info*/) {
    constexpr std::string_view kWanted = "numbers of colliders and perhaps \"ground\", as in [0, \"ground\"]";
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
        colliders = ColliderTextures::kBodiesMax;  // its bodies are counted when it is read
    }
    list.bits = 0;
    for (std::size_t i = 0; i < from.array()->size(); ++i) {
        const TomlValue one = from[i];
        if (one.node().is_integer()) {
            const std::int64_t body = one.whole({0.0, static_cast<double>(colliders) - 1.0});
            list.bits |= 1U << std::min<std::int64_t>(body, ColliderTextures::kGroups - 1);
            continue;
        }
        if (!one.node().is_string()) {
            one.wrongType(kWanted);
        }
        static_cast<void>(one.word(kGround));
        if (no_ground) {
            one.fail(from.name() + " names the ground, which ground.enabled = false takes away");
        }
        list.bits |= kCollidesWithGround;
    }
}

std::optional<FieldFault> check(FlowFile& flow, const GivenFields& /*given*/) {
    flow.origin += ": flow.raw: ";
    if (auto checked = checkFlowSize({flow.size[0], flow.size[1], flow.size[2]}); !checked) {
        return FieldFault{"size", "is not possible: " + checked.error().message};
    }
    for (int i = 0; i < 3; ++i) {
        if (!(flow.box_min[i] < flow.box_max[i])) {
            return FieldFault{"box_min", "is not below flow.box_max on the " + std::string(1, "xyz"[i]) +
                                             " axis; move one of them"};
        }
    }
    return std::nullopt;
}

void readScene(const TomlValue& top, Scene& scene) {
    readToml(top, scene);
}

Result<Scene> parseScene(std::string_view text, const fs::path& path, const fs::path& root) {
    Scene scene;
    RELIEF_TRY(readTomlFile(text, {oneLine(path.native()), path.parent_path(), root, "scene"},
                            [&](const TomlValue& top) { readScene(top, scene); }));
    return scene;
}

Result<Scene> loadScene(const fs::path& path, const fs::path& root) {
    const auto bytes = RELIEF_TRY(readFile(path, kSceneBytesMax));
    return parseScene({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, path, root);
}

}  // namespace relief
