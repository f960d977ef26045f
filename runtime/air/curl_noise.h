// Turbulence: the curl of a random potential, which therefore has no divergence: particles neither gather nor
// thin out. The C++ side of shaders/curl_noise.glsl.
//
// The potential's three components are gradient noise with a quintic fade, so that the velocity, their
// analytic derivative, is continuous and smooth. The gradients come of a hash of the lattice point by integer
// arithmetic: every machine draws the same. In time the noise goes from one independent pattern to the next,
// by weights whose squares sum to 1, so that it is equally strong at all times.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>

namespace relief {

struct CurlNoise {
    static constexpr int kOctavesMax = 4;
    static constexpr float kRateMax = 1000.0F;  ///< of drift / scale, patterns a second

    float amplitude = 0.0F;  ///< root mean square speed, object units a second, ≥ 0; 0: no noise
    /// Side of a lattice cell, about the radius of the largest eddies: object units, > 0.
    float scale = 1.0F;
    int octaves = 2;  ///< 1 … kOctavesMax; each is half as large, half as fast and half as long-lived
    /// Object units a second, ≥ 0: an eddy gives way to another every size / drift seconds.
    float drift = 0.0F;
    std::uint32_t seed = 1;
    friend bool operator==(const CurlNoise&, const CurlNoise&) = default;
};

/// The velocity at p and time t, object units a second. No speed exceeds 12 · √2 · 15/√85 · amplitude (the
/// sum of all gradients at their worst); in practice none exceeds 4 · amplitude.
/// \param t  seconds, as curlTime() gives them.
[[nodiscard]] glm::vec3 curlVelocity(const CurlNoise& noise, const glm::vec3& p, float t);

/// Seconds since the start, taken back by whole periods of the noise: a float then holds them finely enough
/// however long a run takes.
[[nodiscard]] float curlTime(const CurlNoise& noise, double seconds);

/// What the shader is told: the first octave's factor of the potential's derivative.
[[nodiscard]] float curlGain(const CurlNoise& noise);

}  // namespace relief
