#include "runtime/air/curl_noise.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include "shaders/shader_constants.h"

namespace relief {
namespace {

// 1 / root mean square of the curl of one octave of potential whose gradients have components of ±1, ±3, ±5,
// ±7, which have variance 21: the mean over a cell of Σ over its corners of |∂(weight · offset)/∂x|² is
// 0.744295091, and six such derivatives make a squared speed.
constexpr float kUnitRms = 0.103262385F;

std::uint32_t hash(std::uint32_t x) {
    x ^= x >> 16U;
    x *= 0x9E3779B1U;
    x ^= x >> 15U;
    x *= 0x85EBCA77U;
    x ^= x >> 13U;
    return x;
}

/// Column c is the gradient of the potential's component c.
glm::mat3 gradients(std::uint32_t h) {
    glm::mat3 g;
    for (int c = 0; c < 3; ++c) {
        for (int axis = 0; axis < 3; ++axis) {
            g[c][axis] = static_cast<float>(static_cast<int>(h & 7U) * 2 - 7);
            h >>= 3U;
        }
    }
    return g;
}

float fade(float f) {
    return f * f * f * (f * (f * 6.0F - 15.0F) + 10.0F);
}

glm::vec3 octave(const glm::vec3& point, std::uint32_t key, std::uint32_t next_key, const glm::vec2& share) {
    glm::vec3 f;
    std::uint32_t cell[3];
    glm::vec3 weight[2];
    glm::vec3 slope[2];
    for (int axis = 0; axis < 3; ++axis) {
        // NaN becomes a number, and casts to int stay defined.
        const float q = point[axis] > -kCurlCellMax ? std::fmin(point[axis], kCurlCellMax) : -kCurlCellMax;
        const float low = std::floor(q);
        cell[axis] = static_cast<std::uint32_t>(static_cast<std::int32_t>(low));
        const float x = q - low;
        f[axis] = x;
        weight[1][axis] = fade(x);
        weight[0][axis] = 1.0F - weight[1][axis];
        slope[1][axis] = 30.0F * x * x * (x * (x - 2.0F) + 1.0F);
        slope[0][axis] = -slope[1][axis];
    }
    glm::mat3 jacobian(0.0F);
    for (std::uint32_t z = 0; z < 2; ++z) {
        const std::uint32_t hz = hash(key + cell[2] + z);
        const std::uint32_t next_hz = hash(next_key + cell[2] + z);
        for (std::uint32_t y = 0; y < 2; ++y) {
            const std::uint32_t hy = hash(hz + cell[1] + y);
            const std::uint32_t next_hy = hash(next_hz + cell[1] + y);
            for (std::uint32_t x = 0; x < 2; ++x) {
                glm::mat3 g = share.x * gradients(hash(hy + cell[0] + x));
                if (share.y > 0.0F) {
                    g += share.y * gradients(hash(next_hy + cell[0] + x));
                }
                const glm::vec3 d = f - glm::vec3(x, y, z);
                const glm::vec3 w(weight[x].x, weight[y].y, weight[z].z);
                const glm::vec3 dw(slope[x].x * w.y * w.z, w.x * slope[y].y * w.z, w.x * w.y * slope[z].z);
                const float all = w.x * w.y * w.z;
                for (int c = 0; c < 3; ++c) {
                    jacobian[c] += all * g[c] + glm::dot(g[c], d) * dw;
                }
            }
        }
    }
    return {jacobian[2].y - jacobian[1].z, jacobian[0].z - jacobian[2].x, jacobian[1].x - jacobian[0].y};
}

}  // namespace

float curlGain(const CurlNoise& noise) {
    float squares = 0.0F;
    for (int o = 0; o < noise.octaves; ++o) {
        squares += std::ldexp(1.0F, -2 * o);
    }
    return noise.amplitude * kUnitRms / std::sqrt(squares);
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
    const float per_unit = 1.0F / noise.scale;
    const float rate = noise.drift * per_unit;
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
        sum += octave(p * (per_unit * twice), hash(base + (index & mask)), hash(base + ((index + 1U) & mask)),
                      share) /
               twice;
    }
    return gain * sum;
}

}  // namespace relief
