// SPDX-License-Identifier: Apache-2.0
// False colours of maps and slices.

/** CSS colour of map i; equals mapColor() below. */
export const mapCss = (i) => `oklch(0.74 0.13 ${25 + 137.508 * i})`;

/** CSS colour of a cell of map i; equals levelColor() below. light: 0 to 1. */
export const levelCss = (i, level, light) => `oklch(${light * (0.9 - 0.36 * level)} ${0.05 + 0.11 * level} ${25 + 137.508 * i})`;

/** CSS gradient of distances, from inside to outside; equals distanceColor() below. */
export const kLegend = `linear-gradient(to right, ${Array.from({ length: 33 }, (_, i) => {
    const amount = Math.abs(i / 16 - 1);
    const chroma = 0.135 * Math.sqrt(amount) * (1 - 0.25 * amount);
    return `oklch(${0.97 - 0.56 * amount} ${chroma} ${i < 16 ? 255 : 60 - 12 * amount})`;
})})`;

export const kColorsGlsl = `
vec3 oklch(float lightness, float chroma, float hue) {
    float a = chroma * cos(radians(hue));
    float b = chroma * sin(radians(hue));
    vec3 lms = vec3(lightness + 0.3963377774 * a + 0.2158037573 * b,
                    lightness - 0.1055613458 * a - 0.0638541728 * b,
                    lightness - 0.0894841775 * a - 1.2914855480 * b);
    lms = lms * lms * lms;
    vec3 c = clamp(mat3(4.0767416621, -1.2684380046, -0.0041960863, -3.3077115913, 2.6097574011, -0.7034186147,
                        0.2309699292, -0.3413193965, 1.7076147010) * lms, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
// u: distance divided by the displayed range; blue inside, orange outside.
vec3 distanceColor(float u) {
    float amount = min(abs(u), 1.0);
    float chroma = 0.135 * sqrt(amount) * (1.0 - 0.25 * amount);
    return oklch(0.97 - 0.56 * amount, chroma, u < 0.0 ? 255.0 : 60.0 - 12.0 * amount);
}
// Consecutive maps have distinct colours.
vec3 mapColor(int i) {
    return oklch(0.74, 0.13, 25.0 + mod(137.508 * float(i), 360.0));
}
// The colour of a cell of map i. level: 0 for a root, 1 for the smallest cells.
vec3 levelColor(int i, float level) {
    return oklch(0.9 - 0.36 * level, 0.05 + 0.11 * level, 25.0 + mod(137.508 * float(i), 360.0));
}
// The colour of a point in a slice.
vec3 fieldColor(float f, int map, float range) {
    return map < 0 ? vec3(0.8, 0.7, 0.82) : f >= 1e29 ? vec3(0.865, 0.87, 0.86) : distanceColor(f / range);
}
`;
