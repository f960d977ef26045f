// SPDX-License-Identifier: Apache-2.0
// Defines the settings of a height map: `relief bake --heights`.
//
//     spacing=1,low=0,high=500           an integer grey image: value 0 maps to low, the largest value to high
//     spacing=0.5,hole=-9999             an EXR image in metres
//     low=-10,high=90,width=2048,hole=0  raw samples of 16 bits, little-endian
//     spacing=30,type=int16,order=big    raw samples in metres, big-endian, as in .hgt files
//
// Column numbers grow along +x, row numbers along +z, and heights along +y, as in glTF. The surface is bilinear between
// four samples, and the ground below it is solid. A square with a hole at a corner has no ground.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "bake/import/sample_rows.h"
#include "formats/base/field.h"
#include "formats/base/result.h"

namespace relief {

/// "a/b/c"
struct HeightsOffset {
    glm::dvec3 at{0.0};
    friend bool operator==(const HeightsOffset&, const HeightsOffset&) = default;
};
[[nodiscard]] bool parseText(std::string_view word, HeightsOffset& offset);
[[nodiscard]] std::string fieldText(const HeightsOffset& offset);

/// The type of raw samples. Signed integers and floats are metres.
enum class SampleType : std::uint8_t { kUint16, kInt16, kFloat32 };
template <>
inline constexpr std::array<std::string_view, 3> kWordsOf<SampleType>{"uint16", "int16", "float32"};
enum class ByteOrder : std::uint8_t { kLittle, kBig };
template <>
inline constexpr std::array<std::string_view, 2> kWordsOf<ByteOrder>{"little", "big"};

struct HeightsSpec {
    double spacing = 1.0;
    std::optional<double> low;
    std::optional<double> high;
    std::optional<double> hole;
    std::optional<std::uint32_t> width;
    std::optional<SampleType> type;
    std::optional<ByteOrder> order;
    HeightsOffset offset;
    std::uint32_t tile = 1024;
};

/// Limit of the magnitude of low, high, offset and heights; metres.
inline constexpr double kHeightMax = 1e9;
inline constexpr double kHoleMax = 3.4028235e38;  ///< the largest float, as written in text

void fields(FieldVisitor& visit, HeightsSpec& spec);

/// Parses settings. Errors: kUsage, naming the key and the fix.
[[nodiscard]] Result<HeightsSpec> parseHeightsSpec(std::string_view text);
/// Adds the settings that the extension of a raw file implies: .hgt is big-endian int16 with -32768 as hole.
[[nodiscard]] HeightsSpec completed(HeightsSpec spec, const std::filesystem::path& file);
/// Lists the spacing, and every other setting that differs from its default; parseHeightsSpec() reads the result.
[[nodiscard]] std::string toString(const HeightsSpec& spec);

}  // namespace relief
