// SPDX-License-Identifier: Apache-2.0
#include "runtime/air/air.h"
#include "runtime/air/curl_noise.h"

namespace relief {

void fields(FieldVisitor& visit, Attractor& a) {
    visit("position", a.position, {"Centre of attraction", "[x, y, z]", kPointRange, {}, kRequired});
    visit("strength", a.strength,
          {"Acceleration at the radius; below 0 it repels",
           "1/s²",
           within(kAccelerationMax),
           {},
           {.required = true, .not_zero = true}});
    visit("radius", a.radius, {"Distance up to which the strength grows", {}, kSizeRange, {}, kRequired});
    visit("falloff", a.falloff,
          {"Beyond the radius the strength falls with this power of the distance", {}, {0.0, 2.0}});
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
          {"Distance from the axis up to which the strength grows", {}, kSizeRange, {}, kRequired});
    visit("falloff", v.falloff,
          {"Beyond the radius the strength falls with this power of the distance", {}, {0.0, 2.0}});
}

void fields(FieldVisitor& visit, AirSettings& air) {
    visit("attractor", air.attractors,
          {.help = "Points that attract or repel",
           .rules = {.most = AirSettings::kAttractorsMax},
           .left_out = true});
    visit("vortex", air.vortices,
          {.help = "Axes that particles are driven round",
           .rules = {.most = AirSettings::kVorticesMax},
           .left_out = true});
    visit("curl_noise", air.curl_noise, {.help = "Turbulence; it needs drag", .left_out = true});
}

void fields(FieldVisitor& visit, CurlNoise& noise) {
    visit("amplitude", noise.amplitude,
          {"Mean speed of the turbulence", "1/s", {0.0, kSpeedMax, false}, {}, kRequired});
    visit("scale", noise.scale, {"Size of the largest eddies", {}, kSizeRange, {}, kRequired});
    visit("octaves", noise.octaves,
          {"Sizes of eddies, each half as large as the one before", {}, {1.0, CurlNoise::kOctavesMax}});
    visit("drift", noise.drift,
          {"Speed at which eddies give way to others; up to 1000 scales a second", "1/s", kSpeedRange});
    visit("seed", noise.seed, {"Seed of the pattern"});
}

}  // namespace relief
