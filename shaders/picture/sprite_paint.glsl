// SPDX-License-Identifier: Apache-2.0
// The colour of a sprite at a pixel.
//!include picture/sprite_shading.glsl
//!include picture/sprite_light.glsl
//!include base/srgb.glsl

uniform float u_soft;             // object units; 0: hard edges
uniform vec2 u_depth;             // window depth of view distance t: x + y / t
uniform bool u_srgb;              // the target holds sRGB values

#ifdef RELIEF_CELLS
uniform highp sampler2D u_atlas;  // linear, premultiplied by alpha
uniform ivec2 u_cells;            // columns, rows
uniform float u_levels_max;       // above it cells would run into each other

// A cell of the atlas at a place of it, -1…1, y upwards, where it is so many pixels wide.
vec4 cellAt(vec2 at, float number, float pixels) {
    vec2 size = vec2(textureSize(u_atlas, 0)) / vec2(u_cells);
    // The level at which a texel is a pixel: known, as the sprite's size is.
    float level = clamp(floor(log2(max(size.x, size.y) / pixels) + 0.5), 0.0, u_levels_max);
    vec2 edge = 0.5 * exp2(level) / size;  // half a texel: filtering must not reach the next cell
    int cell = int(number) % (u_cells.x * u_cells.y);
    vec2 inside = clamp(vec2(0.5, -0.5) * at + 0.5, edge, 1.0 - edge);
    return textureLod(u_atlas, (vec2(cell % u_cells.x, cell / u_cells.x) + inside) / vec2(u_cells), level);
}
#endif

// A round sprite, by the share of its radius: its edge is a smooth step.
vec4 bodyAt(vec2 at, float radius, float per_edge) {
    float inside = clamp((1.0 - radius) * per_edge, 0.0, 1.0);
    return vec4(inside * inside * (3.0 - 2.0 * inside));
}

#ifdef RELIEF_CELLS
// The sprite at a place in the picture's frame: colour times alpha, and alpha.
// `cell`: cosine and sine of its rotation; cell, -1: a soft disc; pixels
vec4 bodyAt(vec2 at, float radius, float per_edge, vec4 cell) {
    if (cell.z >= 0.0) {
        vec2 own = vec2(cell.x * at.x + cell.y * at.y, cell.x * at.y - cell.y * at.x);
        // The corners of a turned cell stand out of its point.
        return max(abs(own.x), abs(own.y)) > 1.0 ? vec4(0.0) : cellAt(own, cell.z, cell.w);
    }
    return bodyAt(at, radius, per_edge);
}
#endif

float distanceOf(float depth) {
    return u_depth.y / (depth - u_depth.x);
}

// The share of a sprite, at the window depth of its front, that is left before the depth `behind`.
float softShare(float behind, float depth) {
    return clamp((distanceOf(behind) - distanceOf(depth)) / u_soft, 0.0, 1.0);
}

// Colour times alpha, and alpha, at a place of the sprite, -1…1; alpha 0 where nothing is seen.
// `body`: the sprite there, premultiplied; `shown`: its opacity.
vec4 paintOf(Shading shading, vec2 at, float radius, vec4 body, float shown) {
    float alpha = shown * body.a;
    if (alpha <= SPRITE_UNSEEN) {
        return vec4(0.0);
    }
    vec3 light = vec3(1.0);
    if (shading.lit) {
        light = spriteLight(vec3(at, sqrt(max(1.0 - radius * radius, 0.0))), shading.sun, shading.sky);
    }
    vec4 color = vec4(shading.color * light * (shown * body.rgb), alpha);
    if (u_srgb) {
        color.rgb = alpha * srgbOf(min(color.rgb / alpha, vec3(1.0)));
    }
    return color;
}
