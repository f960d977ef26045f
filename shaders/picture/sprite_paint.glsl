// SPDX-License-Identifier: Apache-2.0
// The colour of a sprite at a pixel.
//!include picture/sprite_shading.glsl
//!include picture/sprite_light.glsl
//!include base/srgb.glsl

uniform float u_soft;             // object units; 0: hard edges
uniform vec2 u_depth;             // window depth of view distance t: x + y / t
uniform bool u_srgb;              // the target stores sRGB values

#ifdef RELIEF_CELLS
uniform highp sampler2D u_atlas;  // linear, premultiplied by alpha
uniform ivec2 u_cells;            // columns, rows
uniform float u_levels_max;       // at higher levels, cells would bleed into each other

// Samples a cell of the atlas at a position in -1…1, y upwards; pixels: width of the cell on screen.
vec4 cellAt(vec2 at, float number, float pixels) {
    vec2 size = vec2(textureSize(u_atlas, 0)) / vec2(u_cells);
    // The level at which a texel covers a pixel follows from the sprite's size.
    float level = clamp(floor(log2(max(size.x, size.y) / pixels) + 0.5), 0.0, u_levels_max);
    vec2 edge = 0.5 * exp2(level) / size;  // half a texel: filtering must not reach the next cell
    int cell = int(number) % (u_cells.x * u_cells.y);
    vec2 inside = clamp(vec2(0.5, -0.5) * at + 0.5, edge, 1.0 - edge);
    return textureLod(u_atlas, (vec2(cell % u_cells.x, cell / u_cells.x) + inside) / vec2(u_cells), level);
}
#endif

// Returns the coverage of a round sprite by the fraction of its radius: its edge is a smooth step.
vec4 bodyAt(vec2 at, float radius, float per_edge) {
    float inside = clamp((1.0 - radius) * per_edge, 0.0, 1.0);
    return vec4(inside * inside * (3.0 - 2.0 * inside));
}

#ifdef RELIEF_CELLS
// Samples the sprite at a position in the picture's frame: premultiplied colour, and alpha.
// `cell`: cosine and sine of its rotation; atlas cell, -1: a soft disc; pixels
vec4 bodyAt(vec2 at, float radius, float per_edge, vec4 cell) {
    if (cell.z >= 0.0) {
        vec2 own = vec2(cell.x * at.x + cell.y * at.y, cell.x * at.y - cell.y * at.x);
        // Pixels of a point outside its rotated cell are transparent.
        return max(abs(own.x), abs(own.y)) > 1.0 ? vec4(0.0) : cellAt(own, cell.z, cell.w);
    }
    return bodyAt(at, radius, per_edge);
}
#endif

float distanceOf(float depth) {
    return u_depth.y / (depth - u_depth.x);
}

// Returns the fraction of a sprite, with its front at window depth `depth`, that remains visible in front of `behind`.
float softFraction(float behind, float depth) {
    return clamp((distanceOf(behind) - distanceOf(depth)) / u_soft, 0.0, 1.0);
}

// Returns premultiplied colour, and alpha, at a position of the sprite in -1…1; alpha is 0 if invisible. `body`: the
// sprite there, premultiplied; `shown`: its opacity.
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
