// SPDX-License-Identifier: Apache-2.0
#include "bake/views/map_spec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <span>
#include <utility>

#include "formats/base/text.h"
#include "formats/fields/text.h"
#include "formats/patch_tree.h"

namespace relief {
namespace {

constexpr auto kKeys = [] {
    std::array<std::string_view, kMapKeys.size()> keys;
    std::ranges::transform(kMapKeys, keys.begin(), &MapKey::key);
    return keys;
}();

/// Minimum sine of the angle between up and dir: below it, rounding could rotate the image.
constexpr double kUpSineMin = 1e-4;

struct AxisWord {
    std::string_view word;
    glm::vec3 direction;
};
constexpr AxisWord kAxisWords[] = {{"+x", {1, 0, 0}},  {"-x", {-1, 0, 0}}, {"+y", {0, 1, 0}},
                                   {"-y", {0, -1, 0}}, {"+z", {0, 0, 1}},  {"-z", {0, 0, -1}},
                                   {"x", {1, 0, 0}},   {"y", {0, 1, 0}},   {"z", {0, 0, 1}}};

tl::unexpected<Error> usage(const std::string& message) {
    return fail(ErrorCode::kUsage, message);
}

tl::unexpected<Error> badValue(std::string_view key, std::string_view value, const std::string& expected) {
    return usage(std::string(key) + " is '" + cleanUtf8(value) + "' but must be " + expected);
}

tl::unexpected<Error> unknown(const std::string& what, std::string_view word,
                              std::span<const std::string_view> known) {
    const std::string guess = didYouMean(word, known);
    return usage("unknown " + what + " '" + cleanUtf8(word) + "'" +
                 (guess.empty() ? "; use one of " + listed(known) : guess));
}

/// Returns the index of one of two words.
Result<bool> parseWord(std::string_view key, std::string_view value,
                       const std::array<std::string_view, 2>& words) {
    if (value != words[0] && value != words[1]) {
        return usage(std::string(key) + " " + expectedOneOfMessage(value, words));
    }
    return value == words[1];
}

/// Returns `count` numbers, or an empty vector if `value` is anything else.
std::vector<float> parseNumbers(std::string_view value, std::size_t count) {
    const std::vector<std::string_view> parts = split(value, '/');
    std::vector<float> numbers;
    for (const std::string_view part : parts) {
        const std::optional<float> number = parseFloat(part);
        if (!number || parts.size() != count) {
            return {};
        }
        numbers.push_back(*number + 0.0F);  // −0 becomes 0, so that equal settings have equal texts
    }
    return numbers;
}

Result<glm::vec3> parseDirection(std::string_view key, std::string_view value) {
    for (const AxisWord& axis : kAxisWords) {
        if (axis.word == value) {
            return axis.direction;
        }
    }
    const std::vector<float> n = parseNumbers(value, 3);
    if (n.empty() || glm::vec3(n[0], n[1], n[2]) == glm::vec3(0.0F)) {
        return badValue(key, value, "+x, -x, +y, -y, +z, -z or a vector a/b/c that is not 0/0/0");
    }
    return glm::vec3(n[0], n[1], n[2]);
}

std::string directionText(const glm::vec3& direction) {
    for (const AxisWord& axis : kAxisWords) {
        if (axis.direction == direction) {
            return std::string(axis.word);
        }
    }
    return shortest(direction);
}

class MapSpecBuilder {
  public:
    explicit MapSpecBuilder(const MapSpecDefaults& defaults) : defaults_(defaults) {
        spec_.format = defaults.front_back;
        spec_.decode = defaults.decode;
    }

    /// Must be called first, because the valid keys depend on the format.
    [[nodiscard]] Result<void> setFormat(std::string_view word) {
        const auto* found = std::ranges::find(kMapFormats, word, &MapFormatInfo::name);
        if (found == kMapFormats.end()) {
            return unknown("format", word, kMapFormatWords);
        }
        spec_.format = static_cast<MapFormat>(found - kMapFormats.begin());
        if (isFrontBack(spec_.format)) {
            spec_.format = defaults_.front_back;
        } else if (spec_.format == MapFormat::kPatches) {
            spec_.decode = Decode::kPlane;
        }
        return {};
    }
    [[nodiscard]] Result<void> set(std::string_view key, std::string_view value) {
        const auto* found = std::ranges::find(kKeys, key);
        if (found == kKeys.end()) {
            return unknown("key", key, kKeys);
        }
        const auto index = static_cast<std::size_t>(found - kKeys.begin());
        if (std::exchange(seen_.at(index), true)) {
            return usage(std::string(key) + " is set twice; remove one");
        }
        if (const std::string useless = whyIneffective(key); !useless.empty()) {
            return usage(std::string(key) + useless);
        }
        if (key == "dir") {
            spec_.direction = RELIEF_TRY(parseDirection(key, value));
        } else if (key == "up") {
            spec_.up = RELIEF_TRY(parseDirection(key, value));
        } else if (key == "center") {
            const std::vector<float> n = parseNumbers(value, 3);
            if (n.empty()) {
                return badValue(key, value, "three numbers a/b/c");
            }
            spec_.center = glm::vec3(n[0], n[1], n[2]);
        } else {
            return key == "size"     ? setSize(value)
                   : key == "box"    ? setBox(value)
                   : key == "budget" ? setBudget(value)
                   : key == "texel"  ? setTexel(value)
                                     : setWord(key, value);
        }
        return {};
    }
    /// Validates the combination of the keys.
    [[nodiscard]] Result<MapSpec> finish() const {
        if (isCube() && spec_.center && spec_.box) {
            return usage("a cube with a box is centred on the box; remove center or box");
        }
        RELIEF_TRY(checkUp(spec_));
        return spec_;
    }

  private:
    [[nodiscard]] bool isCube() const { return spec_.format == MapFormat::kCube8; }
    /// Returns why a key has no effect for the format and how to fix it; empty if it has an effect.
    [[nodiscard]] std::string whyIneffective(std::string_view key) const {
        const bool of_patches = key == "budget" || key == "texel";
        if (of_patches != (spec_.format == MapFormat::kPatches)) {
            return of_patches ? " applies only to patches; set size"
                              : " does not apply to patches; remove it";
        }
        if ((key == "dir" || key == "up") && isCube()) {
            return " does not apply to a cube, which has all directions; remove it";
        }
        if (key == "center" && !isCube()) {
            return " applies only to a cube; use box to move an orthographic map";
        }
        return key == "depth" && !isFrontBack(spec_.format) ? " applies only to front-back; remove it" : "";
    }
    Result<void> setWord(std::string_view key, std::string_view value) {
        if (key == "depth") {
            const bool fixed = RELIEF_TRY(parseWord(key, value, {"half", "unorm16"}));
            spec_.format = fixed ? MapFormat::kFrontBackFixed : MapFormat::kFrontBackHalf;
        } else if (key == "decode") {
            const bool plane = RELIEF_TRY(parseWord(key, value, {"projected", "plane"}));
            spec_.decode = plane ? Decode::kPlane : Decode::kProjected;
        } else if (!isFrontBack(spec_.format)) {
            const bool greater = RELIEF_TRY(parseWord(key, value, {"less", "greater"}));
            spec_.compare = greater ? Compare::kGreater : Compare::kLess;
        } else {
            return usage("front-back keeps both surfaces; remove compare");
        }
        return {};
    }
    Result<void> setSize(std::string_view value) {
        const std::vector<std::string_view> parts = split(value, 'x');
        const std::optional<std::uint64_t> width = parseUnsigned(parts.front());
        const std::optional<std::uint64_t> height = parseUnsigned(parts.back());
        if (parts.size() > 2 || !width || !height || (isCube() && *width != *height)) {
            return badValue("size", value, isCube() ? "N, as a cube's faces are square" : "N or WxH");
        }
        spec_.width = RELIEF_TRY(checkMapSize(*width, spec_.format, "size"));
        spec_.height = RELIEF_TRY(checkMapSize(*height, spec_.format, "size"));
        return {};
    }
    Result<void> setBox(std::string_view value) {
        if (value == "tight") {
            return {};
        }
        const std::vector<float> n = parseNumbers(value, 6);
        if (n.empty()) {
            return badValue("box", value, "tight or two corners x0/y0/z0/x1/y1/z1");
        }
        const Bounds box{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
        if (!(box.min.x < box.max.x && box.min.y < box.max.y && box.min.z < box.max.z)) {
            return badValue("box", value, "two corners x0/y0/z0/x1/y1/z1 with x0 < x1, y0 < y1 and z0 < z1");
        }
        spec_.box = box;
        return {};
    }
    Result<void> setBudget(std::string_view value) {
        const std::optional<std::uint64_t> bytes = parseByteCount(value);
        if (!bytes || *bytes < kPatchBytesMin || *bytes > kPatchBytesMax) {
            return badValue("budget", value,
                            std::to_string(kPatchBytesMin) + " to " + std::to_string(kPatchBytesMax) +
                                " bytes, such as 1MB");
        }
        spec_.bytes = *bytes;
        return {};
    }
    Result<void> setTexel(std::string_view value) {
        const std::optional<float> texel = parseFloat(value);
        if (!texel || !(*texel >= 1e-15F && *texel <= 1e15F)) {
            return badValue("texel", value, "a length above 0, in the collider's units");
        }
        spec_.texel = *texel;
        return {};
    }

    MapSpecDefaults defaults_;
    MapSpec spec_;
    std::array<bool, kKeys.size()> seen_{};  // by key
};

}  // namespace

Result<void> checkUp(const MapSpec& spec) {
    if (!spec.up) {
        return {};
    }
    // In double, divided by the largest component first: squares of floats could overflow or vanish.
    const auto unit = [](const glm::vec3& v) {
        const float largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        return glm::normalize(glm::dvec3(v) / static_cast<double>(largest));
    };
    if (!(glm::length(glm::cross(unit(spec.direction), unit(*spec.up))) > kUpSineMin)) {
        return usage("up is parallel to dir; change one of them");
    }
    return {};
}

Result<MapSpec> parseMapSpec(std::string_view text, const MapSpecDefaults& defaults) {
    const auto read = [&]() -> Result<MapSpec> {
        MapSpecBuilder builder(defaults);
        const std::size_t colon = text.find(':');
        RELIEF_TRY(builder.setFormat(text.substr(0, colon)));
        if (colon == std::string_view::npos) {
            return builder.finish();
        }
        for (const std::string_view pair : split(text.substr(colon + 1), ',')) {
            const std::size_t equals = pair.find('=');
            const std::string_view key = pair.substr(0, equals);
            if (equals == std::string_view::npos && std::ranges::find(kKeys, key) != kKeys.end()) {
                return usage(std::string(key) + " has no value; write " + std::string(key) + "=…");
            }
            const std::string_view value = equals == std::string_view::npos ? "" : pair.substr(equals + 1);
            RELIEF_TRY(builder.set(key, value));
        }
        return builder.finish();
    };
    return withPrefix("--map '" + cleanUtf8(text) + "'", read());
}

std::string toString(const MapSpec& spec) {
    const bool cube = spec.format == MapFormat::kCube8;
    std::string text = mapFormatName(spec.format);
    char separator = ':';
    const auto add = [&](const char* key, const std::string& value) {
        text.append(1, separator).append(key).append("=").append(value);
        separator = ',';
    };
    if (spec.format == MapFormat::kPatches) {
        if (spec.bytes > 0) {
            add("budget", std::to_string(spec.bytes));
        }
        if (spec.texel > 0.0F) {
            add("texel", shortest(spec.texel));
        }
        return text;
    }
    if (!cube) {
        add("dir", directionText(spec.direction));
        if (spec.up) {
            add("up", directionText(*spec.up));
        }
    }
    if (spec.width != 0) {
        add("size", cube ? std::to_string(spec.width)
                         : std::to_string(spec.width) + "x" + std::to_string(spec.height));
    }
    if (spec.compare) {
        add("compare", compareName(*spec.compare));
    }
    if (spec.center) {
        add("center", shortest(*spec.center));
    }
    if (isFrontBack(spec.format)) {
        add("depth", depthEncodingName(spec.format));
    }
    add("decode", decodeName(spec.decode));
    add("box", spec.box ? shortest(spec.box->min) + '/' + shortest(spec.box->max) : "tight");
    return text;
}

std::vector<MapSpec> paperMapSpecs() {
    std::vector<MapSpec> specs(4);
    for (MapSpec& spec : specs) {
        spec.format = kPaperDefaults.front_back;
        spec.decode = kPaperDefaults.decode;
    }
    specs[0].direction = {-1.0F, 0.0F, 0.0F};
    specs[1].direction = {0.0F, -1.0F, 0.0F};
    specs[2].direction = {0.0F, 0.0F, -1.0F};
    specs[3].format = MapFormat::kCube8;
    return specs;
}

Result<std::uint32_t> checkMapSize(std::uint64_t texels, MapFormat format, const std::string& what) {
    const std::uint32_t smallest = format == MapFormat::kCube8 ? 1 : kMapSizeMin;
    if (texels < smallest) {
        return fail(ErrorCode::kUsage, what + " is " + std::to_string(texels) +
                                           " texels but must be at least " + std::to_string(smallest));
    }
    if (texels > kMapSizeMax) {
        const bool overflow = texels == std::numeric_limits<std::uint64_t>::max();
        return fail(ErrorCode::kLimit, what + " is " + (overflow ? "far too many" : std::to_string(texels)) +
                                           " texels; the limit is " + std::to_string(kMapSizeMax));
    }
    return static_cast<std::uint32_t>(texels);
}

}  // namespace relief
