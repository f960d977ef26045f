// SPDX-License-Identifier: Apache-2.0
// The shading of a sprite, passed from vertices to fragments. Setting up flat varyings for each small point, and
// unpacking them in each fragment, is most of a sprite's cost. The shading is therefore packed into three words, and
// light that is constant over a sprite is multiplied into its colour:
//
//     bits   0…15          16…31
//     x      red           green          half of the colour, linear
//     y      blue          opacity
//     z      sun 8, sky 8  edge 15, lit 1
struct Shading {
    vec3 color;      // 0…2
    float opacity;
    float sun;       // visible fraction of the sun's disc
    float sky;       // visible fraction of the sky
    float per_edge;  // 1 / the fraction of the radius over which the edge fades, 0…1 / SPRITE_EDGE
    bool lit;        // lit per fragment by sun and sky
};

const float SPRITE_EDGE = 0.35;  // minimum fade
const float SPRITE_UNSEEN = 0.003;  // less opaque sprites are skipped

uint quantized(float value, float steps) {
    return uint(clamp(value, 0.0, 1.0) * steps + 0.5);
}

uvec3 packShading(Shading shading) {
    uvec4 paint = uvec4(clamp(vec4(0.5 * shading.color, shading.opacity), 0.0, 1.0) * 65535.0 + 0.5);
    uint light = quantized(shading.sun, 255.0) | quantized(shading.sky, 255.0) << 8 |
                 quantized(SPRITE_EDGE * shading.per_edge, 32767.0) << 16 | (shading.lit ? 1u << 31 : 0u);
    return uvec3(paint.x | paint.y << 16, paint.z | paint.w << 16, light);
}

Shading unpackShading(uvec3 words) {
    const float PART = 1.0 / 65535.0;
    return Shading((2.0 * PART) * vec3(words.x & 0xffffu, words.x >> 16, words.y & 0xffffu), PART * float(words.y >> 16),
                 float(words.z & 255u) / 255.0, float((words.z >> 8) & 255u) / 255.0,
                 float((words.z >> 16) & 32767u) * (1.0 / (32767.0 * SPRITE_EDGE)), words.z >> 31 != 0u);
}
