// SPDX-License-Identifier: Apache-2.0
// One texel of a depth map in each format: its contents and byte layout.
//
//     format            bytes  channels
//     float32            16    R,G,B = normal x,y,z   A = depth            four little-endian floats
//     fixed8              4    R = normal s   G = normal t   B = depth high byte   A = depth low byte
//     front-back half     8    R = packed normal of the front   G = of the back     four little-endian uint16
//                              B = half-float depth of the front   A = of the back
//     front-back fixed    8    likewise with 16-bit fixed-point depths as in fixed8
//     cube8               4    as fixed8, in six faces
//     patches             8    a record of a tree, or heights: patch_tree.h. encodeTexel() and decodeTexel() exclude it
//
// With the 11 significant bits of a half, depths over a box of length 2 are off by 2·10^-4 on average. Fixed point is
// 32 times finer in the far half of the volume. Half floats are the paper's choice.
//
// Depth is in map coordinates. Orthographic: 0 at the near plane, 1 at the far plane. Cube: distance from the centre in
// units of the normalised volume, in (0, √3]. An empty texel (no surface on its ray) is all zero bits, except in
// float32, where its depth is −1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string_view>

#include "formats/normal_index.h"

namespace relief {

enum class MapFormat : std::uint8_t {
    kFloat32 = 0,
    kFixed8 = 1,
    kFrontBackHalf = 2,
    kCube8 = 3,
    kFrontBackFixed = 4,
    kPatches = 5
};
inline constexpr int kMapFormatCount = 6;

/// Returns whether a texel stores two surfaces, the nearest and the farthest.
[[nodiscard]] constexpr bool isFrontBack(MapFormat format) {
    return format == MapFormat::kFrontBackHalf || format == MapFormat::kFrontBackFixed;
}

inline constexpr std::uint32_t kMapSizeMax = 16384;  ///< texels along one side of a map

/// The properties of a format, see the table above.
struct MapFormatInfo {
    const char* name;          ///< in `relief bake --map` and in reports
    const char* depth;         ///< encoding of depths
    const char* macro;         ///< RELIEF_HAS_<macro> compiles its code in the shaders
    std::size_t texel_size;    ///< bytes; formats of the same size share a texture on the GPU
    std::size_t normal_bytes;  ///< leading bytes of a texel that are normal indices
};
/// Indexed by MapFormat.
inline constexpr std::array<MapFormatInfo, kMapFormatCount> kMapFormats{{
    {"float", "float32", "FLOAT", 16, 0},
    {"fixed8", "unorm16", "FIXED", 4, 2},
    {"front-back", "half", "FRONT_BACK_HALF", 8, 4},
    {"cube", "unorm16", "CUBE", 4, 2},
    {"front-back", "unorm16", "FRONT_BACK_FIXED", 8, 4},
    {"patches", "unorm8", "PATCHES", 8, 0},
}};
/// The distinct names: two formats are named front-back.
inline constexpr std::array<std::string_view, 5> kMapFormatWords{
    kMapFormats[0].name, kMapFormats[1].name, kMapFormats[2].name, kMapFormats[3].name, kMapFormats[5].name};

/// Returns 0 for an unknown format.
[[nodiscard]] constexpr std::size_t texelSize(MapFormat format) {
    const auto index = static_cast<std::size_t>(format);
    return index < kMapFormats.size() ? kMapFormats[index].texel_size : 0;
}

[[nodiscard]] constexpr const char* mapFormatName(MapFormat format) {
    return kMapFormats.at(static_cast<std::size_t>(format)).name;
}

[[nodiscard]] constexpr const char* depthEncodingName(MapFormat format) {
    return kMapFormats.at(static_cast<std::size_t>(format)).depth;
}

/// One surface in a texel.
struct Surface {
    float depth = 0.0F;      ///< in map coordinates
    glm::vec3 normal{0.0F};  ///< unit length, object space, outwards
};

/// The surfaces of a texel; nullopt if empty. Only front-back maps use `back`.
struct Texel {
    std::optional<Surface> front;
    std::optional<Surface> back;
};

/// The largest depth of a cube texel, √3 rounded up to a float: a corner of the normalised volume.
inline constexpr float kCubeDepthMax = 1.7320509F;

/// Steps of a 16-bit fixed-point depth; code 0 means "empty".
inline constexpr int kDepthSteps = 65534;

/// Encodes a depth in 16-bit fixed point: code c in 1…65535 is the depth (c − 1)/kDepthSteps · depth_max.
/// \param depth  clamped to [0, depth_max].
[[nodiscard]] std::uint16_t encodeFixedDepth(float depth, float depth_max);
/// \param code  not 0.
[[nodiscard]] float decodeFixedDepth(std::uint16_t code, float depth_max);

/// Encodes a depth as an IEEE half; 0 means "empty". Written values lie in [2^-14, 1]. Smaller halves are subnormal,
/// and a GL may flush them to zero.
/// \param depth  clamped to that range.
[[nodiscard]] std::uint16_t encodeHalfDepth(float depth);
[[nodiscard]] float decodeHalfDepth(std::uint16_t bits);

/// Writes one texel.
/// \param bytes  exactly texelSize(format) bytes.
void encodeTexel(MapFormat format, const Texel& texel, std::span<std::byte> bytes);

/// A surface and the index encodeNormal(normal). kFloat32 ignores the index; other formats ignore the normal.
struct IndexedSurface {
    Surface surface;
    NormalIndex index;
};
/// Writes one texel from surfaces with encoded normals.
void encodeTexel(MapFormat format, const std::optional<IndexedSurface>& front,
                 const std::optional<IndexedSurface>& back, std::span<std::byte> bytes);

/// Reads one texel. All bytes are valid for the integer formats. Float texels are read unchecked: the container reader
/// has rejected values that are not finite.
[[nodiscard]] Texel decodeTexel(MapFormat format, std::span<const std::byte> bytes);

}  // namespace relief
