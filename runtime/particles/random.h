// SPDX-License-Identifier: Apache-2.0
// Random numbers and what is drawn with them: the same seed gives the same bits on every machine. Sampling
// uses integers, + − × ÷ and square roots alone (IEEE 754 rounds all of them exactly), never the sines and
// logarithms of a C library, whose last bits differ from one to the next.
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
    /// Uniform in [0, 1): a multiple of 2^-24.
    float uniform() { return static_cast<float>(next() >> 8) * 0x1p-24F; }
    /// Uniform in (−1, 1): an odd multiple of 2^-24, never 0, as likely as its negative.
    float signedUniform() {
        return static_cast<float>(static_cast<std::int32_t>(next() >> 8) * 2 + 1 - (1 << 24)) * 0x1p-24F;
    }
    /// Uniform between two numbers, both possible.
    float between(float low, float high) {
        const float t = uniform();
        // This form cannot overflow where high − low would, and the clamp keeps rounding inside.
        return std::clamp((1.0F - t) * low + t * high, low, high);
    }
    /// Uniform in 0 … count − 1, without bias (Lemire 2019).
    /// \param count  at least 1.
    std::uint32_t below(std::uint32_t count);

  private:
    std::uint64_t state_ = 0;
    std::uint64_t increment_ = 1;
};

/// Uniform in the open unit disc, the centre left out.
[[nodiscard]] glm::vec2 inUnitDisc(Pcg32& random);
/// Uniform in the unit ball.
[[nodiscard]] glm::vec3 inUnitBall(Pcg32& random);
/// Uniform on the unit sphere.
[[nodiscard]] glm::vec3 onUnitSphere(Pcg32& random);
/// Of mean 0 and deviation 1, by Marsaglia's polar method. Its tails end at ±8.
[[nodiscard]] float standardNormal(Pcg32& random);

/// 1 − cos of an angle in degrees, 0…180, to the precision of a double even where the angle is small.
[[nodiscard]] double oneMinusCosine(double degrees);

/// A direction within a cone about +z, uniform over its solid angle.
/// \param opening  oneMinusCosine of the cone's half angle, 0…2.
[[nodiscard]] glm::vec3 inCone(Pcg32& random, float opening);

/// v of length 1, however large or small it was; 0 for a vector of zeros, and for one that is not finite.
[[nodiscard]] glm::vec3 unitVector(const glm::vec3& v);

/// Two directions that make a right-handed orthonormal basis with a third (Duff et al. 2017).
struct Basis {
    glm::vec3 x{1.0F, 0.0F, 0.0F};
    glm::vec3 y{0.0F, 1.0F, 0.0F};
    glm::vec3 z{0.0F, 0.0F, 1.0F};

    [[nodiscard]] glm::vec3 toWorld(const glm::vec3& v) const { return v.x * x + v.y * y + v.z * z; }
};
/// \param z  of length 1.
[[nodiscard]] Basis basisAbout(const glm::vec3& z);

}  // namespace relief
