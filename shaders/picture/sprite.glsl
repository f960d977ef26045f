// SPDX-License-Identifier: Apache-2.0
// Computes the sprite of the i-th particle to draw: its look at its age, its position in view space, and its light.
// With RELIEF_LIT the collider shades the particles (particle_light.glsl); otherwise they are unoccluded.
//!include picture/sprite_shading.glsl
//!include picture/sprite_light.glsl
#ifdef RELIEF_LIT
//!include picture/particle_light.glsl
#endif

uniform highp sampler2D u_looks;   // one row per type (runtime/picture/particle_look.h)
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

struct Look {
    float size;      // diameter, object units
    float opacity;   // including fading
    float rotation;  // radians, counter-clockwise
    vec3 color;      // linear
    float cell;      // atlas cell; -1: a soft disc
    float lit;       // 1: lit, 0: emissive
#ifdef RELIEF_STRETCH
    float stretch;   // seconds of the particle's path that the sprite covers
#endif
};

// Returns a uniform number in [-1, 1), different for each particle and salt.
float particleRandom(float id, uint salt) {
    uint seed = (uint(id) * 2u + salt) * 747796405u + 2891336453u;
    uint word = ((seed >> ((seed >> 28) + 4u)) ^ seed) * 277803737u;
    return float(((word >> 22) ^ word) >> 8) / 8388608.0 - 1.0;
}

int keyTexel(int key) {
    return RELIEF_LOOK_HEAD_TEXELS + RELIEF_LOOK_KEY_TEXELS * key;
}

// Returns the look. `birth`: the particle's texel: time of birth, time of death, type, id.
Look lookOf(vec4 birth, float now) {
    int row = clamp(int(birth.z + 0.5), 0, textureSize(u_looks, 0).y - 1);
    vec4 cells = texelFetch(u_looks, ivec2(0, row), 0);
    vec4 light = texelFetch(u_looks, ivec2(1, row), 0);
    float age = now - birth.x;
    float left = birth.y - now;
    float part = clamp(age / max(birth.y - birth.x, 1e-6), 0.0, 1.0);

    // Find the last key at or before this age, or the first key.
    int count = int(light.w);
    int low = 0;
    for (int end = count; end - low > 1;) {
        int middle = (low + end) / 2;
        bool reached = texelFetch(u_looks, ivec2(keyTexel(middle), row), 0).x <= part;
        low = reached ? middle : low;
        end = reached ? end : middle;
    }
    int high = min(low + 1, count - 1);
    vec4 before = texelFetch(u_looks, ivec2(keyTexel(low), row), 0);
    vec4 after = texelFetch(u_looks, ivec2(keyTexel(high), row), 0);
    float share = high > low ? clamp((part - before.x) / (after.x - before.x), 0.0, 1.0) : 0.0;
    vec4 values = mix(before, after, share);

    Look look;
    look.size = values.y;
    float fade = clamp(age / max(light.y, 1e-6), 0.0, 1.0) * clamp(left / max(light.z, 1e-6), 0.0, 1.0);
    look.opacity = values.z * fade;
    look.rotation = values.w + cells.x * particleRandom(birth.w, 0u) + cells.y * particleRandom(birth.w, 1u) * age;
    look.color = mix(texelFetch(u_looks, ivec2(keyTexel(low) + 1, row), 0).rgb,
                     texelFetch(u_looks, ivec2(keyTexel(high) + 1, row), 0).rgb, share);
    look.cell = cells.z < 0.0 ? -1.0 : cells.z + min(floor(part * cells.w), cells.w - 1.0);
    look.lit = light.x;
#ifdef RELIEF_STRETCH
    look.stretch = texelFetch(u_looks, ivec2(2, row), 0).x;
#endif
    return look;
}

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
