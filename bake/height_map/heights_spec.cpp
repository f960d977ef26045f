// SPDX-License-Identifier: Apache-2.0
#include "bake/height_map/heights_spec.h"

#include <set>
#include <vector>

#include "formats/base/text.h"
#include "formats/fields/text.h"

namespace relief {
namespace {

/// Squares along the side of a leaf. Tile sizes are multiples of it, so that leaves of neighbouring tiles coincide.
constexpr std::uint32_t kTileStep = 4;

/// Reads one key, and collects the names of all keys.
class KeySetter : public FieldVisitor {
  public:
    KeySetter(std::string_view key, std::string_view value) : key_(key), value_(value) {}
    void operator()(std::string_view name, FieldRef target, const FieldInfo& info) override {
        names_.push_back(name);
        if (name == key_) {
            const std::string wrong = readWord(value_, info, target);
            known_ = true;
            fault_ = wrong.empty() ? "" : std::string(name) + " " + wrong;
        }
    }
    [[nodiscard]] bool fills() const override { return true; }
    [[nodiscard]] std::string fault() const {
        if (known_) {
            return fault_;
        }
        const std::string guess = didYouMean(key_, names_);
        return "unknown key '" + cleanUtf8(key_) + "'" +
               (guess.empty() ? "; use one of " + listed(names_) : guess);
    }

  private:
    std::string_view key_;
    std::string_view value_;
    std::vector<std::string_view> names_;
    bool known_ = false;
    std::string fault_;
};

/// Returns the error in a combination of valid values; empty if there is none.
std::string faultOf(const HeightsSpec& spec) {
    if (spec.low && spec.high && !(*spec.low < *spec.high)) {
        return "low is " + numberWord(*spec.low) + " but must be below high, " + numberWord(*spec.high) +
               "; swap them";
    }
    if (spec.tile % kTileStep != 0) {
        return "tile is " + std::to_string(spec.tile) + " but must be a multiple of 4; use " +
               std::to_string(spec.tile / kTileStep * kTileStep);
    }
    return {};
}

std::string readPairs(std::string_view text, HeightsSpec& spec) {
    std::set<std::string_view> seen;
    for (const std::string_view pair : split(text, ',')) {
        const std::size_t equals = pair.find('=');
        const std::string_view key = pair.substr(0, equals);
        KeySetter setter(key, equals == std::string_view::npos ? "" : pair.substr(equals + 1));
        fields(setter, spec);
        if (std::string fault = setter.fault(); !fault.empty()) {
            return fault;
        }
        if (!seen.insert(key).second) {
            return std::string(key) + " is given twice; keep one";
        }
    }
    return faultOf(spec);
}

}  // namespace

bool parseText(std::string_view word, HeightsOffset& offset) {
    const std::vector<std::string_view> parts = split(word, '/');
    if (parts.size() != 3) {
        return false;
    }
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> number = parseDouble(parts[static_cast<std::size_t>(axis)]);
        if (!number || !within(kHeightMax).holds(*number)) {
            return false;
        }
        offset.at[axis] = *number + 0.0;  // no −0, so that equal settings have equal text
    }
    return true;
}

std::string fieldText(const HeightsOffset& offset) {
    return numberWord(offset.at.x) + "/" + numberWord(offset.at.y) + "/" + numberWord(offset.at.z);
}

Result<HeightsSpec> parseHeightsSpec(std::string_view text) {
    HeightsSpec spec;
    const std::string fault = readPairs(text, spec);
    if (!fault.empty()) {
        return fail(ErrorCode::kUsage, "--heights '" + cleanUtf8(text) + "': " + fault);
    }
    return spec;
}

HeightsSpec completed(HeightsSpec spec, const std::filesystem::path& file) {
    if (lowerCase(file.extension().string()) == ".hgt") {
        spec.type = spec.type.value_or(SampleType::kInt16);
        spec.order = spec.order.value_or(ByteOrder::kBig);
        if (!spec.hole && spec.type == SampleType::kInt16) {
            spec.hole = -32768.0;
        }
    }
    return spec;
}

std::string toString(const HeightsSpec& spec) {
    std::string text = "spacing=" + numberWord(spec.spacing);
    for (const FieldWords& field : changedFields(spec)) {
        if (field.name != "spacing") {
            text += "," + field.name + "=" + field.words.front();
        }
    }
    return text;
}

void fields(FieldVisitor& visit, HeightsSpec& spec) {
    const auto number = [](std::string_view help) {
        return FieldInfo{.help = help, .range = within(kHeightMax), .must = "a number from -1e9 to 1e9"};
    };
    visit("spacing", spec.spacing,
          {.help = "Distance between samples, in metres",
           .range = {1e-6, 1e6},
           .must = "a length from 0.000001 to 1000000"});
    visit("low", spec.low, number("Height of sample value 0 in metres; only for unsigned samples"));
    visit("high", spec.high,
          number("Height of the largest sample, 65535 or 255, in metres; only for unsigned samples"));
    visit("hole", spec.hole,
          {.help = "Value that marks a hole, as stored in the file",
           .range = within(kHoleMax),
           .fallback = "NaN in floats, -32768 in .hgt, the transparent colour in PNG, otherwise none",
           .must = "a finite number"});
    visit("width", spec.width,
          {.help = "Samples in each row of a raw file",
           .range = {2.0, double{kHeightsSideMax}},
           .fallback = "the side of a square"});
    visit("type", spec.type,
          {.help = "Type of raw samples; int16 and float32 are metres", .fallback = "uint16; int16 in .hgt"});
    visit("order", spec.order, {.help = "Byte order of raw samples", .fallback = "little; big in .hgt"});
    visit("offset", spec.offset,
          {.help = "Position of height 0 at the first sample, in metres",
           .value = "X/Y/Z",
           .must = "three numbers x/y/z from -1e9 to 1e9"});
    visit("tile", spec.tile,
          {.help = "Squares along each side of a tile, a multiple of 4; only for --world",
           .range = {64.0, 8192.0}});
}

}  // namespace relief
