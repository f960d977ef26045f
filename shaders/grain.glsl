// What the vertices of a sprite tell its fragments. What a GPU sets up for each small point and each flat number of it, and
// what each of its fragments works out again, is most of what it costs. So all is packed into three words, and light that
// is the same all over a sprite is already in its colour:
//
//     bits   0…15          16…31
//     x      red           green          half of the colour, linear
//     y      blue          opacity
//     z      sun 8, sky 8  edge 15, lit 1
struct Grain {
    vec3 color;      // 0…2
    float opacity;
    float sun;       // share of the sun's disc that it sees
    float sky;       // share of the sky
    float per_edge;  // 1 / the share of the radius over which it fades, 0…1 / GRAIN_EDGE
    bool lit;        // fragment by fragment, by sun and sky
};

const float GRAIN_EDGE = 0.35;  // the least
const float GRAIN_UNSEEN = 0.003;  // what is no more opaque is left out

uint grainSteps(float value, float steps) {
    return uint(clamp(value, 0.0, 1.0) * steps + 0.5);
}

uvec3 packGrain(Grain grain) {
    uvec4 paint = uvec4(clamp(vec4(0.5 * grain.color, grain.opacity), 0.0, 1.0) * 65535.0 + 0.5);
    uint light = grainSteps(grain.sun, 255.0) | grainSteps(grain.sky, 255.0) << 8 |
                 grainSteps(GRAIN_EDGE * grain.per_edge, 32767.0) << 16 | (grain.lit ? 1u << 31 : 0u);
    return uvec3(paint.x | paint.y << 16, paint.z | paint.w << 16, light);
}

Grain unpackGrain(uvec3 words) {
    const float PART = 1.0 / 65535.0;
    return Grain((2.0 * PART) * vec3(words.x & 0xffffu, words.x >> 16, words.y & 0xffffu), PART * float(words.y >> 16),
                 float(words.z & 255u) / 255.0, float((words.z >> 8) & 255u) / 255.0,
                 float((words.z >> 16) & 32767u) * (1.0 / (32767.0 * GRAIN_EDGE)), words.z >> 31 != 0u);
}
