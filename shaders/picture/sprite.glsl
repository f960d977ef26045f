// SPDX-License-Identifier: Apache-2.0
// Computes the sprite of the i-th particle to draw: its look at its age, its position in view space, and its light.
// With RELIEF_LIT the collider shades the particles (particle_light.glsl); otherwise they are unoccluded.
//!include picture/look.glsl
//!include picture/sprite_shading.glsl
//!include picture/sprite_light.glsl
#ifdef RELIEF_LIT
//!include picture/particle_light.glsl
#endif

uniform highp sampler2D u_position;
uniform highp sampler2D u_birth;
#ifdef RELIEF_STRETCH
uniform highp sampler2D u_velocity;
#endif
uniform highp usampler2D u_order;  // row by row: the index of the i-th sprite; 0 if there is none
uniform bool u_ordered;
uniform int u_width;
uniform int u_extent;
uniform float u_now;
uniform mat4 u_view;
uniform float u_pixels_per_unit;   // pixels per unit length at view distance 1
uniform vec2 u_pixels;             // minimum and maximum sprite size
uniform float u_texel;             // object units of the collider's finest texel

// Returns the particle of the i-th sprite; -1: none.
int particleOf(int i) {
    int width = textureSize(u_order, 0).x;
    uvec4 rank = texelFetch(u_order, ivec2(i % width, i / width), 0);
    return rank.y != 0u ? int(min(rank.x, 2147483647u)) : -1;
}

// Computes the light on the particle, slightly above it: on a surface the point would be half inside.
void receiveLight(vec3 position, float size, float id, inout Shading shading) {
#ifdef RELIEF_LIT
    if (shading.lit) {
        vec3 above = position + vec3(0.0, 1.5 * u_texel + 0.25 * size, 0.0);
        ParticleLight light = particleLight(above, 0.5 + 0.5 * particleRandom(id, 2u), 0.5 + 0.5 * particleRandom(id, 3u));
        shading.sun = light.sun;
        shading.sky = light.sky;
    }
#endif
}

// Smaller sprites, in pixels, are lit uniformly, with the normal at the middle of their hemisphere.
const float SPRITE_FLAT_PIXELS = 4.0;
const vec3 SPRITE_FLAT_NORMAL = vec3(0.0, 0.0, 0.75);

struct Sprite {
    vec3 center;     // view space
    float size;      // diameter, object units
    float distance;  // view distance, > 0
    float pixels;
    float rotation;
    float cell;      // atlas cell; -1: a soft disc
    Shading shading;
#ifdef RELIEF_STRETCH
    vec3 tail;       // view space, relative to the center: the other end of a stretched sprite
    bool stretched;
#endif
};

// Computes the i-th sprite; returns false if there is none.
bool spriteOf(int rank, out Sprite sprite) {
    int index = u_ordered ? particleOf(rank) : rank;
    if (index < 0 || index >= u_extent) {
        return false;
    }
    ivec2 texel = ivec2(index % u_width, index / u_width);
    vec4 position = texelFetch(u_position, texel, 0);
    if (position.w < 0.0) {  // dead
        return false;
    }
    vec4 birth = texelFetch(u_birth, texel, 0);
    Look look = lookOf(birth, u_now);
    sprite.center = (u_view * vec4(position.xyz, 1.0)).xyz;
    sprite.size = look.size;
    sprite.distance = max(-sprite.center.z, 1e-6);
    sprite.rotation = look.rotation;
    sprite.cell = look.cell;
    // Below the minimum size, a sprite keeps its total light by reducing opacity.
    float wanted = look.size * u_pixels_per_unit / sprite.distance;
    sprite.pixels = clamp(wanted, u_pixels.x, u_pixels.y);
    float cover = min(wanted / sprite.pixels, 1.0);
    // The edge fades over a third of the radius, but at least over a pixel.
    float per_edge = min(1.0 / SPRITE_EDGE, 0.5 * sprite.pixels);
    sprite.shading = Shading(look.color, look.opacity * cover * cover, 1.0, 1.0, per_edge, look.lit > 0.5);
#ifdef RELIEF_STRETCH
    sprite.tail = -look.stretch * (mat3(u_view) * texelFetch(u_velocity, texel, 0).xyz);
    sprite.stretched = look.stretch > 0.0;
#endif
    receiveLight(position.xyz, look.size, birth.w, sprite.shading);
    if (sprite.shading.lit && sprite.pixels < SPRITE_FLAT_PIXELS) {
        sprite.shading.color *= spriteLight(SPRITE_FLAT_NORMAL, sprite.shading.sun, sprite.shading.sky);
        sprite.shading.lit = false;
    }
    return true;
}
