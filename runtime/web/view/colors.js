// The false colours of `relief slice`, for scripts and shaders: as bake/picture/slice_image.cpp has them.

const kFar = [0.865, 0.87, 0.86];
const kAbstained = [0.8, 0.7, 0.82];

const toSrgb = (c) => {
    const v = Math.min(Math.max(c, 0), 1);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055;
};

function fromOklch(lightness, chroma, hue) {
    const a = chroma * Math.cos(hue * Math.PI / 180);
    const b = chroma * Math.sin(hue * Math.PI / 180);
    const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
    return [toSrgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            toSrgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            toSrgb(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s)];
}

/** u: distance over its largest shown value; blue inside, orange outside. */
export function distanceColor(u) {
    const amount = Math.min(Math.abs(u), 1);
    const lightness = 0.97 - 0.56 * amount;
    const chroma = 0.135 * Math.sqrt(amount) * (1 - 0.25 * amount);
    return u < 0 ? fromOklch(lightness, chroma, 255) : fromOklch(lightness, chroma, 60 - 12 * amount);
}

/** Of map i: neighbours in the list look unlike. */
export const mapColor = (i) => fromOklch(0.74, 0.13, 25 + 137.508 * i);

export const css = (color) => `rgb(${color.map((v) => Math.round(255 * v)).join(" ")})`;

const vec3 = (color) => `vec3(${color.map((v) => v.toFixed(4)).join(", ")})`;

export const kColorsGlsl = `
vec3 oklch(float lightness, float chroma, float hue) {
    float a = chroma * cos(radians(hue));
    float b = chroma * sin(radians(hue));
    float l = lightness + 0.3963377774 * a + 0.2158037573 * b;
    float m = lightness - 0.1055613458 * a - 0.0638541728 * b;
    float s = lightness - 0.0894841775 * a - 1.2914855480 * b;
    l = l * l * l;
    m = m * m * m;
    s = s * s * s;
    vec3 c = clamp(vec3(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                        -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s), 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}
vec3 distanceColor(float u) {
    float amount = min(abs(u), 1.0);
    float chroma = 0.135 * sqrt(amount) * (1.0 - 0.25 * amount);
    return oklch(0.97 - 0.56 * amount, chroma, u < 0.0 ? 255.0 : 60.0 - 12.0 * amount);
}
vec3 mapColor(int i) {
    return oklch(0.74, 0.13, 25.0 + mod(137.508 * float(i), 360.0));
}
// What a slice shows of a point.
vec3 fieldColor(float f, int map, float range) {
    return map < 0 ? ${vec3(kAbstained)} : f >= 1e29 ? ${vec3(kFar)} : distanceColor(f / range);
}
`;
