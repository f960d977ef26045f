// SPDX-License-Identifier: Apache-2.0
// The look of particles of a type over their age: key-frames, and the texture that shaders/picture/look.glsl reads
// them from.
//
//     row = type     texel 0            turn, spin, first cell (-1: a round dot), number of cells
//                    texel 1            lit, fade in, fade out, number of keys
//                    texel 2            stretch
//                    texels 3 + 2k      age, size, opacity, rotation of key k
//                    texels 4 + 2k      linear colour of key k
//
// Rows are as long as the longest needs.
//
// The tracks of a look may have keys at different ages: a row has a key wherever a track has one, with the
// other tracks' values there, which changes nothing of straight lines.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "formats/base/field.h"
#include "formats/base/result.h"
#include "formats/base/scene_limits.h"
#include "shaders/picture/constants.h"

namespace relief {

template <class T>
struct AgeKey {
    float age = 0.0F;  ///< 0 (birth) … 1 (death)
    T value{};
    friend bool operator==(const AgeKey&, const AgeKey&) = default;
};

/// Up to kLookKeysMax keys, their ages rising. Straight lines between keys, the nearest key's value before
/// the first and after the last.
template <class T>
using AgeTrack = std::vector<AgeKey<T>>;

struct ParticleLook {
    AgeTrack<float> size;       ///< diameter in object units, ≥ 0; empty: the style's
    AgeTrack<glm::vec3> color;  ///< sRGB; interpolated in linear light; empty: the style's
    AgeTrack<float> opacity;    ///< 0…1; empty: the style's
    AgeTrack<float> rotation;   ///< radians, anticlockwise on the picture; empty: 0
    float turn = 0.0F;  ///< radians, ≥ 0: each particle starts turned by its own angle within ± turn
    float spin = 0.0F;  ///< radians a second, ≥ 0: each turns at its own speed within ± spin
    /// Seconds, ≥ 0. Above 0 a sprite reaches along its path from where it is back to where it was so long ago at its present
    /// velocity, as in a picture exposed so long; rotation, turn and spin then do nothing. For quads alone.
    float stretch = 0.0F;
    /// The cells of the atlas played from birth to death, counted row by row from the top left; nullopt: a
    /// round dot.
    std::optional<std::uint32_t> cell_first;
    std::uint32_t cell_last = 0;  ///< ≥ cell_first
    bool lit = true;              ///< false: it shines in its colour whatever light falls on it
    /// Seconds after birth, and before death, over which opacity rises and falls; empty: the style's.
    std::optional<float> fade_in;
    std::optional<float> fade_out;
    friend bool operator==(const ParticleLook&, const ParticleLook&) = default;
};

/// Values of the fields that a look leaves open.
struct LookDefaults {
    float size = 0.01F;
    glm::vec3 color{1.0F};  ///< sRGB
    float opacity = 1.0F;
    float fade_in = 0.0F;
    float fade_out = 0.0F;
    friend bool operator==(const LookDefaults&, const LookDefaults&) = default;
};

inline constexpr std::size_t kLooksMax = 16;
/// Of one track. Texels of a row with all four tracks full are no more than OpenGL ES 3.0 gives a texture: 2048.
inline constexpr std::size_t kLookKeysMax = 255;

/// A track at an age; `otherwise` where it is empty.
template <class T>
[[nodiscard]] T valueAt(const AgeTrack<T>& track, float age, const T& otherwise) {
    if (track.empty()) {
        return otherwise;
    }
    std::size_t next = 0;
    while (next < track.size() && track[next].age <= age) {
        ++next;
    }
    if (next == 0 || next == track.size()) {
        return next == 0 ? track.front().value : track.back().value;
    }
    const AgeKey<T>& low = track[next - 1];
    const AgeKey<T>& high = track[next];
    const float share = (age - low.age) / (high.age - low.age);
    return (1.0F - share) * low.value + share * high.value;
}

/// The rows above; one row of the defaults if there are no looks.
struct PackedLooks {
    std::size_t width = 0;  ///< texels of a row
    std::vector<glm::vec4> texels;
    friend bool operator==(const PackedLooks&, const PackedLooks&) = default;
};
/// Errors: kUsage (too many looks or keys, ages that do not rise or leave 0…1, values out of range).
[[nodiscard]] Result<PackedLooks> packLooks(std::span<const ParticleLook> looks,
                                            const LookDefaults& defaults);

}  // namespace relief
