// The settings of a height map: `relief bake --heights`.
//
//     spacing=1,low=0,high=500           a grey image of whole numbers: 0 stands for low, the largest for high
//     spacing=0.5,hole=-9999             an EXR image of metres
//     low=-10,high=90,width=2048,hole=0  raw samples of 16 bits, little-endian
//
// Columns of samples run along +x, rows along +z, and heights along +y, as glTF has it. The surface is bilinear between four
// samples, and the ground is solid below it. Squares of which a corner is a hole have no ground.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// "a/b/c"
struct HeightsOffset {
    glm::dvec3 at{0.0};
    friend bool operator==(const HeightsOffset&, const HeightsOffset&) = default;
};
[[nodiscard]] bool readForm(std::string_view word, HeightsOffset& offset);
[[nodiscard]] std::string formText(const HeightsOffset& offset);

struct HeightsSpec {
    double spacing = 1.0;
    std::optional<double> low;
    std::optional<double> high;
    std::optional<double> hole;
    std::optional<std::uint32_t> width;
    HeightsOffset offset;
    std::uint32_t tile = 1024;
};

inline constexpr double kHeightMax = 1e9;         ///< of low, high, offset and heights, either sign; metres
inline constexpr double kHoleMax = 3.4028235e38;  ///< the largest float, as it is written
inline constexpr std::uint32_t kHeightsSideMax = 1U << 24;  ///< samples in a row

template <class Visitor, FieldsOf<HeightsSpec> S>
void fields(Visitor& visit, S& spec) {
    const auto number = [](std::string_view help) {
        return FieldInfo{.help = help, .range = within(kHeightMax), .must = "a number from -1e9 to 1e9"};
    };
    visit("spacing", spec.spacing,
          {.help = "Between samples, metres",
           .range = {1e-6, 1e6},
           .must = "a length from 0.000001 to 1000000"});
    visit("low", spec.low, number("Height of sample 0, of images of whole numbers"));
    visit("high", spec.high, number("Height of the largest sample, 65535 or 255"));
    visit("hole", spec.hole,
          {.help = "Sample that is none, as the file has it",
           .range = within(kHoleMax),
           .must = "a finite number"});
    visit("width", spec.width,
          {.help = "Samples in a row of a raw file", .range = {2.0, double{kHeightsSideMax}}});
    visit("offset", spec.offset,
          {.help = "Place of the first sample at height 0", .must = "three numbers x/y/z from -1e9 to 1e9"});
    visit("tile", spec.tile, {.help = "Squares along a tile's side, with --world", .range = {64.0, 8192.0}});
}

/// Errors: kUsage, naming the key and the cure.
[[nodiscard]] Result<HeightsSpec> parseHeightsSpec(std::string_view text);
/// Every setting that is not the default: parseHeightsSpec() reads it back.
[[nodiscard]] std::string toString(const HeightsSpec& spec);

}  // namespace relief
