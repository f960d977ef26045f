// SPDX-License-Identifier: Apache-2.0
#include "runtime/air/air.h"
#include "runtime/air/curl_noise.h"

namespace relief {

void fields(FieldVisitor& visit, Attractor& a) {
    visit("position", a.position, {"Centre of attraction", "[x, y, z]", kPointRange, {}, kRequired});
    visit("strength", a.strength,
          {"Acceleration at the radius; negative values repel",
           "1/s²",
           within(kAccelerationMax),
           {},
           {.required = true, .not_zero = true}});
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
          {"Acceleration at the radius, right-handed about the axis",
           "1/s²",
           within(kAccelerationMax),
           {},
           {.required = true, .not_zero = true}});
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

}  // namespace relief
