// SPDX-License-Identifier: Apache-2.0
// Turbulence: the curl of a random potential. It is divergence-free, so particles neither cluster nor thin out.
// Parameters of shaders/air/curl_noise.glsl.
//
// The potential is noise on the simplex lattice (K. Perlin, 2001; S. Gustavson, "Simplex noise demystified", 2005): the
// sum of contributions from the four corners of a simplex. A corner contributes (a + b × d)(1/2 - |d|²)³ / 6, where d
// is the offset from the corner, and a and b are random vectors of the corner. The curl of a contribution (R. Bridson
// et al., "Curl-noise for procedural fluid flow", 2007) is t² ((4t/3 - 1/2) b + (b·d) d + a × d) with t = 1/2 - |d|²,
// and 0 for t < 0. The velocity and its first derivative are continuous. Vector a rotates the air about the corner; b
// moves the air through the corner. If a and b are equally long, the mean square speed varies least over space: from
// 0.68 to 1.38 times its mean. On a cubic lattice it varies from 0.62 to 1.34; with three gradients (nine numbers) per
// corner it would vary from 0.60 to 3.3.
//
// The random vectors come from an integer hash of the lattice point and are identical on every machine. Over time the
// noise blends from one independent pattern to the next; the squares of the weights sum to 1, which keeps its strength
// constant.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "formats/base/field.h"
#include "formats/base/scene_limits.h"

namespace relief {

struct CurlNoise {
    static constexpr int kOctavesMax = 4;
    static constexpr float kRateMax = 1000.0F;  ///< limit of drift / scale, patterns per second

    float amplitude = 0.0F;  ///< root mean square speed, object units/s, ≥ 0; 0: no noise
    /// Approximate radius of the largest eddies, object units, > 0. The RMS of an octave's velocity derivatives is 5.4 ·
    /// its RMS speed / its own scale. Lattice edges are 1.10 and 1.27 scales long.
    float scale = 1.0F;
    int octaves = 2;  ///< 1 … kOctavesMax; each has half the size, speed and lifetime of the previous one
    /// Object units/s, ≥ 0. An eddy is replaced every size / drift seconds.
    float drift = 0.0F;
    std::uint32_t seed = 1;
    friend bool operator==(const CurlNoise&, const CurlNoise&) = default;
};

void fields(FieldVisitor& visit, CurlNoise& noise);
[[nodiscard]] std::optional<FieldFault> check(CurlNoise& noise, const GivenFields& given);

/// Wraps seconds since the start by the period of the noise, so that a float has enough resolution however long a run
/// takes.
[[nodiscard]] float curlTime(const CurlNoise& noise, double seconds);

/// Returns object units/s per unit of the first octave's curl, for the shader.
[[nodiscard]] float curlGain(const CurlNoise& noise);

/// Returns the first octave's lattice units per object unit, for the shader.
[[nodiscard]] float curlUnits(const CurlNoise& noise);

}  // namespace relief
