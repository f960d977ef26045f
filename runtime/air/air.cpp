#include "runtime/air/air.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "formats/base/finite.h"

namespace relief {
namespace {

bool positive(float x) {
    return x > 0.0F && std::isfinite(x);
}

bool knownFalloff(int falloff) {
    return falloff >= 0 && falloff <= 2;
}

/// The strength at distance r over r: a field is this times an offset that is r long.
float profile(float r, float radius, int falloff) {
    if (r <= radius) {
        return 1.0F / radius;
    }
    const float s = radius / r;
    return (falloff == 0 ? 1.0F : (falloff == 1 ? s : s * s)) / r;
}

tl::unexpected<Error> wrong(const char* what, std::size_t index, const char* why) {
    return fail(ErrorCode::kUsage, std::string(what) + " " + std::to_string(index) + " " + why);
}

Result<void> checkNoise(const CurlNoise& noise) {
    if (!(noise.amplitude >= 0.0F) || !std::isfinite(noise.amplitude) || !positive(noise.scale) ||
        !std::isfinite(1.0F / noise.scale) || noise.octaves < 1 || noise.octaves > CurlNoise::kOctavesMax) {
        return fail(ErrorCode::kUsage,
                    "curl noise needs an amplitude of 0 or more, a scale above 0 and 1 to 4 octaves");
    }
    if (!(noise.drift >= 0.0F && noise.drift / noise.scale <= CurlNoise::kRateMax)) {
        return fail(ErrorCode::kUsage, "curl noise needs a drift of 0 to 1000 times its scale a second");
    }
    return {};
}

}  // namespace

std::optional<FieldFault> check(CurlNoise& noise, const GivenFields& /*given*/) {
    noise.scale = std::max(noise.scale, 1e-9F);  // its reciprocal stays a float
    if (noise.drift / noise.scale > CurlNoise::kRateMax) {
        return FieldFault{"drift", "is more than 1000 times curl_noise.scale a second; lower it"};
    }
    return std::nullopt;
}

Result<void> checkAir(const AirSettings& air) {
    if (!isFinite(air.wind)) {
        return fail(ErrorCode::kUsage, "the wind must be finite");
    }
    if (air.viscosity && !(*air.viscosity >= 0.0F && std::isfinite(*air.viscosity))) {
        return fail(ErrorCode::kUsage, "the viscosity must be 0 or more, and finite");
    }
    if (air.attractors.size() > AirSettings::kAttractorsMax ||
        air.vortices.size() > AirSettings::kVorticesMax) {
        return fail(ErrorCode::kUsage, std::to_string(air.attractors.size()) + " attractors and " +
                                           std::to_string(air.vortices.size()) +
                                           " vortices are more than 8 of one kind");
    }
    for (std::size_t i = 0; i < air.attractors.size(); ++i) {
        const Attractor& one = air.attractors[i];
        if (!isFinite(one.position) || !std::isfinite(one.strength)) {
            return wrong("attractor", i, "needs a finite position and strength");
        }
        if (!positive(one.radius) || !positive(one.reach) || !knownFalloff(one.falloff)) {
            return wrong("attractor", i, "needs a radius and a reach above 0, and a falloff of 0, 1 or 2");
        }
    }
    for (std::size_t i = 0; i < air.vortices.size(); ++i) {
        const Vortex& one = air.vortices[i];
        const float length = glm::length(one.axis);
        if (!isFinite(one.center) || !std::isfinite(one.strength) || !positive(length)) {
            return wrong("vortex", i, "needs a finite center and strength, and an axis other than 0");
        }
        if (!positive(one.radius) || !knownFalloff(one.falloff)) {
            return wrong("vortex", i, "needs a radius above 0 and a falloff of 0, 1 or 2");
        }
    }
    if (air.curl_noise) {
        RELIEF_TRY(checkNoise(*air.curl_noise));
    }
    return air.flow ? checkFlow(*air.flow) : Result<void>{};
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

float airTime(const AirSettings& air, double seconds) {
    return air.curl_noise ? curlTime(*air.curl_noise, seconds) : static_cast<float>(seconds);
}

float stokesRate(float viscosity, float radius, float mass) {
    return kSixPi * viscosity * radius / mass;
}

}  // namespace relief
