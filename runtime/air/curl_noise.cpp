#include "runtime/air/curl_noise.h"

#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "shaders/air/constants.h"

namespace relief {
namespace {

// 1 / root mean square of the curl of one octave, as octave() has it, all over space. Corners' numbers, ±1, ±3 …
// ±15, are independent, of variance 85; and there are two corners in each unit of space. So the mean square is
// twice the integral of one corner's, 85 t⁴ (2r² + 3u² + 2u r² + r⁴) with t = 1/2 - r² and u = 4t/3 - 1/2, over
// the ball t > 0: 85 · 8√2 π / 6435 = 0.469488795.
constexpr float kUnitRms = 1.45944383F;

// Units of the lattice in a `scale`. With so many, the mean square of the velocity's nine derivatives, over that
// of the velocity, is 29.1052974 / scale²: what noise of three gradients a corner has on a cubic lattice of side
// `scale`, with a quintic fade. In units of the lattice it is 330/7, by integrals as above.
constexpr float kUnitsPerScale = 0.785738567F;

std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16U;
    x *= 0x9E3779B1U;
    x ^= x >> 15U;
    x *= 0x85EBCA77U;
    x ^= x >> 13U;
    return x;
}

// The increment of a lattice point's number along each axis of the skewed lattice. Of six thousand random
// triples, this is the one whose numbers repeat farthest away: 1379 units.
constexpr std::uint32_t kSteps[3] = {0xEBD5C9D3U, 0x3966CCC3U, 0xFE172BC7U};

/// A lattice point's share: the potential near it is (a + b × d)(1/2 - |d|²)³ / 6.
struct Corner {
    glm::vec3 a{0.0F};
    glm::vec3 b{0.0F};
};

/// \param number  of the lattice point
/// \param key     of the pattern
Corner draw(std::uint32_t number, std::uint32_t key) {
    // hash() without its last step, which mends bits below 7; and both patterns share the first one.
    std::uint32_t h = number ^ (number >> 16U);
    h = (h ^ key) * 0x9E3779B1U;
    h = (h ^ (h >> 16U)) * 0x85EBCA77U;
    const auto odd = [&](unsigned bit) {
        return static_cast<float>(static_cast<int>(h >> bit & 15U) * 2 - 15);
    };
    return {{odd(27), odd(19), odd(11)}, {odd(23), odd(15), odd(7)}};
}

float fade(float f) {
    return f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F);
}

glm::vec3 octave(const glm::vec3& point, const std::uint32_t (&keys)[2], const glm::vec2& share) {
    glm::vec3 q;
    for (int axis = 0; axis < 3; ++axis) {
        // NaN becomes a number, and casts to int stay defined.
        q[axis] = point[axis] > -kCurlCellMax ? std::fmin(point[axis], kCurlCellMax) : -kCurlCellMax;
    }
    q += (q.x + q.y + q.z) * (1.0F / 3.0F);
    // The offsets come of the fractions: however coarse floats are far away, they are those of some point of
    // the cell.
    const glm::vec3 low = glm::floor(q);
    const glm::vec3 f = q - low;
    std::uint32_t number = 0;
    for (int axis = 0; axis < 3; ++axis) {
        number += static_cast<std::uint32_t>(static_cast<std::int32_t>(low[axis])) * kSteps[axis];
    }
    // The cell's cube is six simplices. From corner to corner one goes along the axis of the largest fraction
    // first, of the least last.
    const bool xy = f.x >= f.y;
    const bool xz = f.x >= f.z;
    const bool yz = f.y >= f.z;
    const int first = xy && xz ? 0 : (yz && !xy ? 1 : 2);
    const int last = !xy && !xz ? 0 : (xy && !yz ? 1 : 2);
    const int axes[3] = {first, 3 - first - last, last};
    glm::vec3 d = f - (f.x + f.y + f.z) * (1.0F / 6.0F);
    glm::vec3 curl(0.0F);
    for (int i = 0;; ++i) {
        Corner corner = draw(number, keys[0]);
        corner.a *= share.x;
        corner.b *= share.x;
        if (share.y > 0.0F) {
            const Corner next = draw(number, keys[1]);
            corner.a += share.y * next.a;
            corner.b += share.y * next.b;
        }
        const float t = std::fmax(0.5F - glm::dot(d, d), 0.0F);
        curl += t * t *
                ((t * (4.0F / 3.0F) - 0.5F) * corner.b + glm::dot(corner.b, d) * d + glm::cross(corner.a, d));
        if (i == 3) {
            return curl;
        }
        d[axes[i]] -= 1.0F;
        d += 1.0F / 6.0F;
        number += kSteps[axes[i]];
    }
}

}  // namespace

float curlGain(const CurlNoise& noise) {
    float squares = 0.0F;
    for (int o = 0; o < noise.octaves; ++o) {
        squares += std::ldexp(1.0F, -2 * o);
    }
    return noise.amplitude * kUnitRms / std::sqrt(squares);
}

float curlUnits(const CurlNoise& noise) {
    return kUnitsPerScale / noise.scale;
}

float curlTime(const CurlNoise& noise, double seconds) {
    if (!(noise.drift > 0.0F)) {
        return 0.0F;
    }
    const double period = kCurlPatterns * static_cast<double>(noise.scale) / static_cast<double>(noise.drift);
    const double rest = std::fmod(seconds, period);
    return static_cast<float>(rest < 0.0 ? rest + period : rest);
}

glm::vec3 curlVelocity(const CurlNoise& noise, const glm::vec3& p, float t) {
    glm::vec3 sum(0.0F);
    const float per_unit = curlUnits(noise);
    const float rate = noise.drift / noise.scale;
    const float gain = curlGain(noise);
    for (int o = 0; o < noise.octaves; ++o) {
        const auto twice = static_cast<float>(1 << o);
        const float now = t * (rate * twice);
        const float pattern = std::floor(now);
        const auto mask = static_cast<std::uint32_t>((kCurlPatterns << o) - 1);
        const auto index = static_cast<std::uint32_t>(static_cast<std::int32_t>(pattern));
        const std::uint32_t base = hash(noise.seed + static_cast<std::uint32_t>(o) * 0x632BE5ABU);
        const float s = fade(now - pattern);
        const glm::vec2 share = glm::vec2(1.0F - s, s) / std::sqrt((1.0F - s) * (1.0F - s) + s * s);
        const std::uint32_t keys[2] = {hash(base + (index & mask)), hash(base + ((index + 1U) & mask))};
        sum += octave(p * (per_unit * twice), keys, share) / twice;
    }
    return gain * sum;
}

}  // namespace relief
