// SPDX-License-Identifier: Apache-2.0
// The appearance of a particle at its age: keyframes of its type, from the texture of runtime/picture/particle_look.h.
uniform highp sampler2D u_looks;  // one row per type

struct Look {
    float size;      // diameter, object units
    float opacity;   // including fading
    float rotation;  // radians, counter-clockwise
    vec3 color;      // linear
    float cell;      // atlas cell; -1: a soft disc
    float lit;       // 1: lit, 0: emissive
#ifdef RELIEF_STRETCH
    float stretch;   // seconds of its path that it covers
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
