// SPDX-License-Identifier: Apache-2.0
// Converts linear light, 0…1, to sRGB (IEC 61966-2-1).
vec3 srgbOf(vec3 linear) {
    vec3 curve = 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055;
    return mix(curve, 12.92 * linear, vec3(lessThan(linear, vec3(0.0031308))));
}

// Converts sRGB to linear light.
vec3 linearOf(vec3 srgb) {
    return mix(pow((srgb + 0.055) / 1.055, vec3(2.4)), srgb / 12.92, vec3(lessThanEqual(srgb, vec3(0.04045))));
}
