#include "runtime/collider/deformation.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

#include "formats/base/finite.h"

namespace relief {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kRates[3] = {1.0, 1.25, 0.8};

bool isUnit(const glm::vec3& v) {
    return isFinite(v) && std::abs(glm::length(v) - 1.0F) < 1e-3F;
}

/// sin(x)/x
float sinc(float x) {
    return std::abs(x) < 1e-2F ? 1.0F - x * x / 6.0F : std::sin(x) / x;
}

/// About an axis of length 1 (Rodrigues).
glm::vec3 turn(const glm::vec3& p, const glm::vec3& axis, float angle) {
    const float c = std::cos(angle);
    return c * p + std::sin(angle) * glm::cross(axis, p) + (1.0F - c) * glm::dot(axis, p) * axis;
}

glm::vec3 bend(const Deformation& d, float angle, const glm::vec3& q) {
    const float s = glm::dot(q, d.along);
    const float inside = std::clamp(s, d.range_low, d.range_high);
    const float arc = inside - d.range_low;
    const float a = angle * arc / (d.range_high - d.range_low);
    const glm::vec3 side = glm::cross(d.axis, d.along);  // where the far end goes for an angle above 0
    // The chord of the arc turns by half its angle.
    const glm::vec3 line = d.range_low * d.along +
                           arc * sinc(0.5F * a) * (std::cos(0.5F * a) * d.along + std::sin(0.5F * a) * side);
    return line + turn(q - inside * d.along, d.axis, a);
}

}  // namespace

Result<void> checkDeformation(const Deformation& d) {
    const bool numbers = std::isfinite(d.amplitude) && std::isfinite(d.frequency) && std::isfinite(d.phase) &&
                         d.frequency >= 0.0F && isFinite(d.center);
    if (!numbers) {
        return fail(ErrorCode::kUsage, "a deformation needs finite numbers and a frequency of at least 0");
    }
    if (d.kind == DeformKind::kWobble) {
        if (!(d.wavelength > 0.0F) || !std::isfinite(d.wavelength)) {
            return fail(ErrorCode::kUsage, "the wavelength of a wobble must be above 0");
        }
        return {};
    }
    if (std::abs(d.amplitude) > static_cast<float>(kTurn)) {
        return fail(ErrorCode::kUsage, "the amplitude of a bend or a twist is at most a whole turn, 2π");
    }
    if (!isUnit(d.axis) ||
        (d.kind == DeformKind::kBend && !(isUnit(d.along) && std::abs(glm::dot(d.axis, d.along)) < 1e-3F))) {
        return fail(ErrorCode::kUsage,
                    "a deformation's axis must have length 1, and so must what a bend goes along, across it");
    }
    if (!(d.range_low < d.range_high) || !std::isfinite(d.range_high - d.range_low)) {
        return fail(ErrorCode::kUsage, "the range of a deformation must rise");
    }
    return {};
}

DeformMoment momentOf(const Deformation& d, double time) {
    const double turns = static_cast<double>(d.frequency) * time;
    DeformMoment moment;
    moment.angle = static_cast<float>(
        d.amplitude * std::sin(kTurn * (turns - std::floor(turns)) + static_cast<double>(d.phase)));
    for (int k = 0; k < 3; ++k) {
        moment.phases[k] = static_cast<float>(
            std::fmod(static_cast<double>(d.phase) + k - kTurn * kRates[k] * turns, kTurn));
    }
    return moment;
}

glm::vec3 deform(const Deformation& d, const DeformMoment& moment, const glm::vec3& p,
                 const glm::vec3& normal) {
    if (d.kind == DeformKind::kWobble) {
        const float number = static_cast<float>(kTurn) / d.wavelength;
        float sum = 0.0F;
        for (int k = 0; k < 3; ++k) {
            sum += std::sin(number * p[k] + moment.phases[k]);
        }
        return p + d.amplitude / 3.0F * sum * normal;
    }
    const glm::vec3 q = p - d.center;
    if (d.kind == DeformKind::kBend) {
        return d.center + bend(d, moment.angle, q);
    }
    const float share = (std::clamp(glm::dot(q, d.axis), d.range_low, d.range_high) - d.range_low) /
                        (d.range_high - d.range_low);
    return d.center + turn(q, d.axis, moment.angle * share);
}

Bounds deformedBounds(const Deformation& d, std::span<const glm::vec3> positions) {
    Bounds bounds;
    for (const glm::vec3& p : positions) {
        bounds.add(p);
    }
    if (d.kind == DeformKind::kWobble) {
        bounds.min -= std::abs(d.amplitude);
        bounds.max += std::abs(d.amplitude);
        return bounds;
    }
    // Between two samples of the angle a point is at most half of its way from one of them.
    constexpr int kSamples = 64;
    float way = 0.0F;
    bounds = {};
    for (const glm::vec3& p : positions) {
        glm::vec3 before(0.0F);
        for (int i = 0; i <= kSamples; ++i) {
            DeformMoment moment;
            moment.angle = d.amplitude * (2.0F * static_cast<float>(i) / kSamples - 1.0F);
            const glm::vec3 at = deform(d, moment, p, glm::vec3(0.0F));
            way = i > 0 ? std::max(way, glm::length(at - before)) : way;
            bounds.add(at);
            before = at;
        }
    }
    // A little more: the way is an arc.
    bounds.min -= 0.51F * way;
    bounds.max += 0.51F * way;
    return bounds;
}

}  // namespace relief
