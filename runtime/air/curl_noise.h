// SPDX-License-Identifier: Apache-2.0
// Turbulence: the curl of a random potential, which therefore has no divergence: particles neither gather nor
// thin out. Settings of shaders/air/curl_noise.glsl.
//
// The potential is noise on the simplex lattice (K. Perlin, 2001; S. Gustavson, "Simplex noise demystified",
// 2005): the four corners of a simplex have a share in it. A corner's is (a + b × d)(1/2 - |d|²)³ / 6, where d
// is the offset from the corner, and a and b are vectors of its own. Its curl (R. Bridson et al., "Curl-noise
// for procedural fluid flow", 2007), in closed form, is t² ((4t/3 - 1/2) b + (b·d) d + a × d) with
// t = 1/2 - |d|², and 0 where t < 0: the velocity has no jump and no kink. a turns the air about the corner, b
// drives it through. With both equally strong, the mean square of the speed varies least over space, from 0.68
// to 1.38 of its mean; on a cubic lattice it is 0.62 to 1.34, and with the nine numbers of three gradients a
// corner it would be 0.60 to 3.3.
//
// The numbers come of a hash of the lattice point by integer arithmetic: every machine draws the same. In time
// the noise goes from one independent pattern to the next, by weights whose squares sum to 1, so that it is
// equally strong at all times.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>

#include "formats/base/field.h"
#include "formats/base/scene_limits.h"

namespace relief {

struct CurlNoise {
    static constexpr int kOctavesMax = 4;
    static constexpr float kRateMax = 1000.0F;  ///< of drift / scale, patterns a second

    float amplitude = 0.0F;  ///< root mean square speed, object units a second, ≥ 0; 0: no noise
    /// About the radius of the largest eddies, object units, > 0: the derivatives of their velocity have a
    /// root mean square of 5.4 · rms speed / scale. Edges of the lattice are 1.10 and 1.27 scales long.
    float scale = 1.0F;
    int octaves = 2;  ///< 1 … kOctavesMax; each is half as large, half as fast and half as long-lived
    /// Object units a second, ≥ 0: an eddy gives way to another every size / drift seconds.
    float drift = 0.0F;
    std::uint32_t seed = 1;
    friend bool operator==(const CurlNoise&, const CurlNoise&) = default;
};

void fields(FieldVisitor& visit, CurlNoise& noise);
[[nodiscard]] std::optional<FieldFault> check(CurlNoise& noise, const GivenFields& given);

/// Seconds since the start, taken back by whole periods of the noise: a float then holds them finely enough
/// however long a run takes.
[[nodiscard]] float curlTime(const CurlNoise& noise, double seconds);

/// For the shader: the first octave's factor of the potential's derivative.
[[nodiscard]] float curlGain(const CurlNoise& noise);

/// For the shader: the first octave's units of the lattice per object unit.
[[nodiscard]] float curlUnits(const CurlNoise& noise);

}  // namespace relief
