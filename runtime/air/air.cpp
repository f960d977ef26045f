// SPDX-License-Identifier: Apache-2.0
#include "runtime/air/air.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <string>

#include "formats/base/finite.h"

namespace relief {
namespace {

// Reciprocal of the RMS of the curl of one octave, over all space. The random numbers of a corner, ±1, ±3 … ±15, are
// independent with variance 85, and there are two corners per unit of volume. The mean square is therefore twice the
// integral of 85 t⁴ (2r² + 3u² + 2u r² + r⁴), with t = 1/2 - r² and u = 4t/3 - 1/2, over the ball t > 0 of one corner:
// 85 · 8√2 π / 6435 = 0.469488795.
constexpr float kUnitRms = 1.45944383F;

// Lattice units per `scale`. With this value, the mean square of the velocity's nine derivatives, divided by that of
// the velocity, is 29.1052974 / scale². This equals noise with three gradients per corner and a quintic fade on a cubic
// lattice of side `scale`. In lattice units the ratio is 330/7, by similar integrals.
constexpr float kUnitsPerScale = 0.785738567F;

bool positive(float x) {
    return x > 0.0F && std::isfinite(x);
}

bool knownFalloff(int falloff) {
    return falloff >= 0 && falloff <= 2;
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
        return fail(ErrorCode::kUsage, "curl noise needs a drift of 0 to 1000 times its scale per second");
    }
    return {};
}

}  // namespace

void fields(FieldVisitor& visit, Attractor& a) {
    visit("position", a.position, {"Centre of attraction", "[x, y, z]", kPointRange, {}, kRequired});
    visit("strength", a.strength,
          {.help = "Acceleration at the radius; negative values repel",
           .unit = "1/s²",
           .range = within(kAccelerationMax),
           .rules = {.required = true, .not_zero = true}});
    visit("radius", a.radius, {"Distance at which the strength peaks", {}, kSizeRange, {}, kRequired});
    visit("falloff", a.falloff, {"Exponent of the decrease with distance beyond the radius", {}, {0.0, 2.0}});
    visit("reach", a.reach,
          {.help = "Distance beyond which there is no force",
           .range = kSizeRange,
           .fallback = "endless",
           .left_out = true});
}

void fields(FieldVisitor& visit, Vortex& v) {
    visit("center", v.center, {"A point of the axis", "[x, y, z]", kPointRange, {}, kRequired});
    visit("axis", v.axis,
          {"Direction of the axis, of any length", "[x, y, z]", kPointRange, {}, {.unit_length = true}});
    visit("strength", v.strength,
          {.help = "Acceleration at the radius, right-handed about the axis",
           .unit = "1/s²",
           .range = within(kAccelerationMax),
           .rules = {.required = true, .not_zero = true}});
    visit("radius", v.radius,
          {"Distance from the axis at which the strength peaks", {}, kSizeRange, {}, kRequired});
    visit("falloff", v.falloff, {"Exponent of the decrease with distance beyond the radius", {}, {0.0, 2.0}});
}

void fields(FieldVisitor& visit, AirSettings& air) {
    visit("attractor", air.attractors,
          {.help = "Points that attract or repel",
           .rules = {.most = AirSettings::kAttractorsMax},
           .left_out = true});
    visit("vortex", air.vortices,
          {.help = "Axes around which particles are accelerated",
           .rules = {.most = AirSettings::kVorticesMax},
           .left_out = true});
    visit("curl_noise", air.curl_noise, {.help = "Turbulence; it needs drag", .left_out = true});
}

void fields(FieldVisitor& visit, CurlNoise& noise) {
    visit("amplitude", noise.amplitude,
          {"Mean speed of the turbulence", "1/s", {0.0, kSpeedMax, false}, {}, kRequired});
    visit("scale", noise.scale, {"Size of the largest eddies", {}, kSizeRange, {}, kRequired});
    visit("octaves", noise.octaves,
          {"Number of eddy sizes, each half of the previous one", {}, {1.0, CurlNoise::kOctavesMax}});
    visit("drift", noise.drift,
          {"Speed at which eddies are replaced; at most 1000 scales per second", "1/s", kSpeedRange});
    visit("seed", noise.seed, {"Seed of the pattern"});
}

std::optional<FieldFault> check(CurlNoise& noise, const GivenFields& /*given*/) {
    noise.scale = std::max(noise.scale, 1e-9F);  // keeps its reciprocal in the range of floats
    if (noise.drift / noise.scale > CurlNoise::kRateMax) {
        return FieldFault{"drift", "is more than 1000 times curl_noise.scale per second; lower it"};
    }
    return std::nullopt;
}

Result<void> checkAir(const AirSettings& air) {
    if (!isFinite(air.wind)) {
        return fail(ErrorCode::kUsage, "the wind must be finite");
    }
    if (air.viscosity && !(*air.viscosity >= 0.0F && std::isfinite(*air.viscosity))) {
        return fail(ErrorCode::kUsage, "the viscosity must be finite and at least 0");
    }
    if (air.attractors.size() > AirSettings::kAttractorsMax ||
        air.vortices.size() > AirSettings::kVorticesMax) {
        return fail(ErrorCode::kUsage, std::to_string(air.attractors.size()) + " attractors and " +
                                           std::to_string(air.vortices.size()) +
                                           " vortices exceed the limit of 8 of each kind");
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

float airTime(const AirSettings& air, double seconds) {
    return air.curl_noise ? curlTime(*air.curl_noise, seconds) : static_cast<float>(seconds);
}

}  // namespace relief
