// SPDX-License-Identifier: Apache-2.0
#include "formats/normal_index.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief {
namespace {

constexpr auto kHalfRange = static_cast<float>(kNormalHalfRange);
constexpr int kLast = 2 * kNormalHalfRange;

/// Sign in the fold of equation 3, which maps the lower octants to the corners of the square.
float signNotZero(float value) {
    return value < 0.0F ? -1.0F : 1.0F;
}

}  // namespace

glm::vec3 decodeNormal(NormalIndex index) {
    const float s = (static_cast<float>(std::min<int>(index.s, kLast)) - kHalfRange) / kHalfRange;
    const float t = (static_cast<float>(std::min<int>(index.t, kLast)) - kHalfRange) / kHalfRange;
    glm::vec3 v(s, t, 1.0F - std::abs(s) - std::abs(t));
    if (v.z < 0.0F) {
        v.x = signNotZero(s) * (1.0F - std::abs(t));
        v.y = signNotZero(t) * (1.0F - std::abs(s));
    }
    return v / std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

const std::array<glm::vec3, 65536>& decodedNormals() {
    static const auto* const table = [] {
        auto* t = new std::array<glm::vec3, 65536>;
        for (std::size_t code = 0; code < t->size(); ++code) {
            (*t)[code] = decodeNormal(unpackNormal(static_cast<std::uint16_t>(code)));
        }
        return t;
    }();
    return *table;
}

NormalIndex lowestAround(const glm::vec3& normal) {
    // Use double throughout: tiny or huge vectors must keep their direction on the octahedron.
    const double x = normal.x;
    const double y = normal.y;
    const double z = normal.z;
    const double norm = std::abs(x) + std::abs(y) + std::abs(z);
    double s = x / norm;
    double t = y / norm;
    if (z < 0.0) {
        const double folded_s = (x < 0.0 ? -1.0 : 1.0) * (1.0 - std::abs(t));
        const double folded_t = (y < 0.0 ? -1.0 : 1.0) * (1.0 - std::abs(s));
        s = folded_s;
        t = folded_t;
    }
    const auto lowest = [](double coordinate) {
        const int index = static_cast<int>(std::floor(coordinate * kNormalHalfRange)) + kNormalHalfRange;
        return static_cast<std::uint8_t>(std::clamp(index, 0, kLast - 1));
    };
    return {lowest(s), lowest(t)};
}

NormalIndex encodeNormal(const glm::vec3& normal) {
    const double x = normal.x;
    const double y = normal.y;
    const double z = normal.z;
    const double norm = std::abs(x) + std::abs(y) + std::abs(z);
    const std::array<glm::vec3, 65536>& decoded_normals = decodedNormals();
    const NormalIndex low = lowestAround(normal);
    NormalIndex best;
    double best_cosine = -std::numeric_limits<double>::infinity();
    for (int dt = 0; dt <= 1; ++dt) {
        for (int ds = 0; ds <= 1; ++ds) {
            const NormalIndex candidate{static_cast<std::uint8_t>(low.s + ds),
                                        static_cast<std::uint8_t>(low.t + dt)};
            const glm::vec3& decoded = decoded_normals[packNormal(candidate)];
            const double cosine = x * decoded.x + y * decoded.y + z * decoded.z;
            // Require a clear improvement, so that ties go to the lower index on every machine.
            if (cosine > best_cosine + 1e-9 * norm) {
                best = candidate;
                best_cosine = cosine;
            }
        }
    }
    return best;
}

}  // namespace relief
