// SPDX-License-Identifier: Apache-2.0
// The appearance of particles over their age: key frames, and the texture that shaders/picture/sprite.glsl reads.
//
//     row = type     texel 0            rotation_spread, spin_spread, first cell (-1: round dot), number of cells
//                    texel 1            lit, fade in, fade out, number of keys
//                    texel 2            stretch
//                    texels 3 + 2k      age, size, opacity, rotation of key k
//                    texels 4 + 2k      linear colour of key k
//
// Rows are padded to the length of the longest row.
//
// The tracks of a look may have keys at different ages. A row has a key at every age at which any track has a key; the
// other tracks are interpolated there.
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

/// Up to kLookKeysMax keys with ascending ages, interpolated linearly; constant before the first and after the last
/// key.
template <class T>
using AgeTrack = std::vector<AgeKey<T>>;

struct ParticleLook {
    AgeTrack<float> size;          ///< diameter in object units, ≥ 0; empty: LookDefaults::size
    AgeTrack<glm::vec3> color;     ///< sRGB; interpolated in linear light; empty: LookDefaults::color
    AgeTrack<float> opacity;       ///< 0…1; empty: LookDefaults::opacity
    AgeTrack<float> rotation;      ///< radians, anticlockwise in the picture; empty: 0
    float rotation_spread = 0.0F;  ///< radians, ≥ 0: random initial rotation within ± rotation_spread
    float spin_spread = 0.0F;      ///< radians/s, ≥ 0: random angular speed within ± spin_spread
    /// Exposure time in seconds, ≥ 0. Above 0, a sprite is stretched back along its velocity by the distance travelled
    /// in that time; rotation, rotation_spread and spin_spread then have no effect. Only for Sprite::kQuad.
    float stretch = 0.0F;
    /// Returns the name of a member that needs Sprite::kQuad, or nullptr.
    [[nodiscard]] const char* needsQuads() const { return stretch > 0.0F ? "stretch" : nullptr; }
    /// Atlas cells shown from birth to death, counted row by row from the top left; nullopt: a round dot.
    std::optional<std::uint32_t> cell_first;
    std::uint32_t cell_last = 0;  ///< ≥ cell_first
    bool lit = true;              ///< false: the colour does not depend on light
    /// Fade times after birth and before death, seconds; nullopt: those of LookDefaults.
    std::optional<float> fade_in;
    std::optional<float> fade_out;
    friend bool operator==(const ParticleLook&, const ParticleLook&) = default;
};

/// Values of fields that a look leaves empty.
struct LookDefaults {
    float size = 0.01F;
    glm::vec3 color{1.0F};  ///< sRGB
    float opacity = 1.0F;
    float fade_in = 0.0F;
    float fade_out = 0.0F;
    friend bool operator==(const LookDefaults&, const LookDefaults&) = default;
};

inline constexpr std::size_t kLooksMax = 16;
/// Maximum keys of a track. With four full tracks, a row has at most 2048 texels, the minimum that OpenGL ES 3.0
/// guarantees.
inline constexpr std::size_t kLookKeysMax = 255;

/// Evaluates a track at an age; returns `fallback` if the track is empty.
template <class T>
[[nodiscard]] T valueAt(const AgeTrack<T>& track, float age, const T& fallback) {
    if (track.empty()) {
        return fallback;
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
    const float t = (age - low.age) / (high.age - low.age);
    return (1.0F - t) * low.value + t * high.value;
}

/// The texture described at the top of this file; one row with the defaults if there are no looks.
struct PackedLooks {
    std::size_t width = 0;  ///< texels per row
    std::vector<glm::vec4> texels;
    friend bool operator==(const PackedLooks&, const PackedLooks&) = default;
};
/// Errors: kUsage (too many looks or keys; ages not ascending or outside 0…1; values out of range).
[[nodiscard]] Result<PackedLooks> packLooks(std::span<const ParticleLook> looks,
                                            const LookDefaults& defaults);

}  // namespace relief
