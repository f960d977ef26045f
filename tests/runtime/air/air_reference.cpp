#include "tests/runtime/air/air_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "shaders/air/constants.h"

namespace relief {
namespace {

/// The strength at distance r over r: a field is this times an offset that is r long.
float profile(float r, float radius, int falloff) {
    if (r <= radius) {
        return 1.0F / radius;
    }
    const float s = radius / r;
    return (falloff == 0 ? 1.0F : (falloff == 1 ? s : s * s)) / r;
}

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

glm::vec3 flowVelocity(const FlowField& flow, const glm::vec3& p) {
    const glm::vec3 scale = flowNodesPerUnit(flow);
    std::array<std::size_t, 3> low{};
    std::array<std::size_t, 3> high{};
    glm::vec3 f;
    for (int axis = 0; axis < 3; ++axis) {
        const bool within = p[axis] >= flow.box_min[axis] && p[axis] <= flow.box_max[axis];
        if (flow.outside == FlowOutside::kZero && !within) {
            return glm::vec3(0.0F);
        }
        const auto a = static_cast<std::size_t>(axis);
        const auto last = static_cast<float>(flow.size[a] - 1);
        const float u = (p[axis] - flow.box_min[axis]) * scale[axis];
        const float in = u > 0.0F ? std::min(u, last) : 0.0F;  // 0 for NaN too
        // The last node has no neighbour beyond it, so the far end of the cell before it is used.
        low[a] =
            std::min(static_cast<std::size_t>(in), static_cast<std::size_t>(std::max(flow.size[a], 2U)) - 2);
        high[a] = std::min(low[a] + 1, static_cast<std::size_t>(flow.size[a]) - 1);
        f[axis] = in - static_cast<float>(low[a]);
    }
    const auto row = [&](std::size_t y, std::size_t z) {
        const glm::vec3* first = &flow.nodes[(z * flow.size[1] + y) * flow.size[0]];
        return glm::mix(first[low[0]], first[high[0]], f.x);
    };
    const auto slice = [&](std::size_t z) { return glm::mix(row(low[1], z), row(high[1], z), f.y); };
    return flow.gain * glm::mix(slice(low[2]), slice(high[2]), f.z);
}

glm::vec3 airVelocity(const AirSettings& air, const glm::vec3& p, float t) {
    glm::vec3 velocity = air.wind;
    if (air.flow) {
        velocity += flowVelocity(*air.flow, p);
    }
    if (air.curl_noise) {
        velocity += curlVelocity(*air.curl_noise, p, t);
    }
    return velocity;
}

glm::vec3 fieldAcceleration(const AirSettings& air, const glm::vec3& p, const glm::vec3& /*v*/, float /*t*/) {
    glm::vec3 sum(0.0F);
    for (const Attractor& one : air.attractors) {
        const glm::vec3 d = one.position - p;
        const float r = glm::length(d);
        if (r <= one.reach) {
            sum += (one.strength * profile(r, one.radius, one.falloff)) * d;
        }
    }
    for (const Vortex& one : air.vortices) {
        const glm::vec3 axis = glm::normalize(one.axis);
        const glm::vec3 d = p - one.center;
        const glm::vec3 across = d - glm::dot(d, axis) * axis;
        sum +=
            (one.strength * profile(glm::length(across), one.radius, one.falloff)) * glm::cross(axis, across);
    }
    return sum;
}

}  // namespace relief
