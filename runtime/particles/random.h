// SPDX-License-Identifier: Apache-2.0
// Random numbers and distributions: the same seed gives the same bits on every machine. Sampling uses only integers and
// + − × ÷ √, which IEEE 754 rounds exactly. Sines and logarithms of C libraries differ in their last bits.
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace relief {

/// PCG32 (O'Neill 2014, pcg32_random_r): 2^64 states, 2^63 streams.
class Pcg32 {
  public:
    explicit Pcg32(std::uint64_t seed, std::uint64_t stream = 0) : increment_(stream << 1 | 1) {
        next();
        state_ += seed;
        next();
    }
    std::uint32_t next() {
        const std::uint64_t old = state_;
        state_ = old * 6364136223846793005U + increment_;
        const auto shifted = static_cast<std::uint32_t>((old >> 18 ^ old) >> 27);
        const auto turn = static_cast<std::uint32_t>(old >> 59);
        return shifted >> turn | shifted << ((32 - turn) & 31);
    }
    /// Returns a uniform number in [0, 1): a multiple of 2^-24.
    float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24F; }
    /// Returns a uniform number in (−1, 1), symmetric about 0: an odd multiple of 2^-24, never 0.
    float signedUniform() {
        return static_cast<float>(static_cast<std::int32_t>(next() >> 8) * 2 + 1 - (1 << 24)) * 0x1p-24F;
    }
    /// Returns a uniform number between two limits, both included.
    float between(float low, float high) {
        const float t = uniform();
        // Unlike high − low, this form cannot overflow. The clamp absorbs rounding.
        return std::clamp((1.0F - t) * low + t * high, low, high);
    }
    /// Returns a uniform point between two corners; draws x, y and z in this order.
    glm::vec3 between(const glm::vec3& low, const glm::vec3& high) {
        return {between(low.x, high.x), between(low.y, high.y), between(low.z, high.z)};
    }
    /// Returns a uniform integer in 0 … count − 1, without bias (Lemire 2019).
    /// \param count  at least 1.
    std::uint32_t below(std::uint32_t count);

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_ = 1;
};

/// Returns a uniform point in the open unit disc, excluding the centre.
[[nodiscard]] glm::vec2 inUnitDisc(Pcg32& random);
/// Returns a uniform point in the unit ball.
[[nodiscard]] glm::vec3 inUnitBall(Pcg32& random);
/// Returns a uniform point on the unit sphere.
[[nodiscard]] glm::vec3 onUnitSphere(Pcg32& random);
/// Returns a standard normal number, by Marsaglia's polar method. Its tails end at ±8.
[[nodiscard]] float standardNormal(Pcg32& random);

/// Returns 1 − cos of an angle in degrees, 0…180, to double precision even for small angles.
[[nodiscard]] double oneMinusCosine(double degrees);

/// Returns a direction in a cone around +z, uniform over its solid angle.
/// \param opening  oneMinusCosine of the cone's half angle, 0…2.
[[nodiscard]] glm::vec3 inCone(Pcg32& random, float opening);

/// Returns v normalized, for any magnitude; 0 for the zero vector and for vectors that are not finite.
[[nodiscard]] glm::vec3 unitVector(const glm::vec3& v);

/// A right-handed orthonormal basis (Duff et al. 2017).
struct Basis {
    glm::vec3 x{1.0F, 0.0F, 0.0F};
    glm::vec3 y{0.0F, 1.0F, 0.0F};
    glm::vec3 z{0.0F, 0.0F, 1.0F};

    [[nodiscard]] glm::vec3 toWorld(const glm::vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};
/// Returns a basis with the given z. \param z  unit length.
[[nodiscard]] Basis basisAbout(const glm::vec3& z);

}  // namespace relief
