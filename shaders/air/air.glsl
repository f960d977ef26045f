// SPDX-License-Identifier: Apache-2.0
// Forces on particles besides collision and gravity. runtime/air/air_block.h lists the defines. Forces without a define
// contribute 0.
//
//     airVelocity        wind + flow + curl noise: acts through drag     object units/s
//     fieldAcceleration  attractors and vortices                         object units/s^2
#ifdef RELIEF_HAS_CURL
//!include air/curl_noise.glsl
#endif

#ifdef RELIEF_HAS_AIR
layout(std140) uniform ReliefAir {
    vec4 air_wind;         // xyz
    ivec4 air_count;       // attractors, vortices, octaves of noise, the noise's seed as bits
    vec4 air_curl;         // gain, lattice units per object unit, patterns per second, 1
    vec4 air_flow_min;     // xyz; w: gain
    vec4 air_flow_max;     // xyz; w: 1 to extend the edge values outside, else 0
    vec4 air_flow_scale;   // xyz: nodes per object unit
    vec4 air_attractor[2 * RELIEF_AIR_FIELDS_MAX];  // position, strength; radius, falloff, reach
    vec4 air_vortex[3 * RELIEF_AIR_FIELDS_MAX];     // centre, strength; unit axis, radius; falloff
};
#endif

#ifdef RELIEF_HAS_FLOW
uniform highp sampler3D u_relief_flow;  // node (i, j, k) is texel (i, j, k)

// Manual trilinear interpolation: GLs need not filter float textures, and may round the weights to 8 bits.
vec3 reliefFlow(vec3 p) {
    bool within = all(greaterThanEqual(p, air_flow_min.xyz)) && all(lessThanEqual(p, air_flow_max.xyz));
    if (!within && air_flow_max.w == 0.0) {
        return vec3(0.0);
    }
    ivec3 last = textureSize(u_relief_flow, 0) - 1;
    vec3 u = clamp((p - air_flow_min.xyz) * air_flow_scale.xyz, vec3(0.0), vec3(last));
    // The last node has no next neighbour, so points at it use the cell before it.
    ivec3 a = clamp(ivec3(u), ivec3(0), max(last - 1, 0));
    ivec3 b = min(a + 1, last);
    vec3 f = u - vec3(a);
    vec3 aa = mix(texelFetch(u_relief_flow, a, 0).xyz,
                  texelFetch(u_relief_flow, ivec3(b.x, a.y, a.z), 0).xyz, f.x);
    vec3 ba = mix(texelFetch(u_relief_flow, ivec3(a.x, b.y, a.z), 0).xyz,
                  texelFetch(u_relief_flow, ivec3(b.x, b.y, a.z), 0).xyz, f.x);
    vec3 ab = mix(texelFetch(u_relief_flow, ivec3(a.x, a.y, b.z), 0).xyz,
                  texelFetch(u_relief_flow, ivec3(b.x, a.y, b.z), 0).xyz, f.x);
    vec3 bb = mix(texelFetch(u_relief_flow, ivec3(a.x, b.y, b.z), 0).xyz,
                  texelFetch(u_relief_flow, b, 0).xyz, f.x);
    return air_flow_min.w * mix(mix(aa, ba, f.y), mix(ab, bb, f.y), f.z);
}
#endif

// Returns the velocity of the air at p. t: seconds, from airTime() in runtime/air/air.h.
vec3 airVelocity(vec3 p, float t) {
    vec3 velocity = vec3(0.0);
#ifdef RELIEF_HAS_AIR
    velocity += air_wind.xyz;
#endif
#ifdef RELIEF_HAS_FLOW
    velocity += reliefFlow(p);
#endif
#ifdef RELIEF_HAS_CURL
    velocity += curlVelocity(p, t, air_curl, air_count.z, uint(air_count.w));
#endif
    return velocity;
}

// Returns strength(r) / r, as a factor for an offset of length r. The strength is linear inside the radius.
float airProfile(float r, float radius, float falloff) {
    if (r <= radius) {
        return 1.0 / radius;
    }
    float s = radius / r;
    return (falloff < 0.5 ? 1.0 : (falloff < 1.5 ? s : s * s)) / r;
}

// v and t are reserved for future fields.
vec3 fieldAcceleration(vec3 p, vec3 v, float t) {
    vec3 sum = vec3(0.0);
#ifdef RELIEF_HAS_ATTRACTORS
    for (int i = 0; i < air_count.x; ++i) {
        vec4 place = air_attractor[2 * i];
        vec4 shape = air_attractor[2 * i + 1];
        vec3 d = place.xyz - p;
        float r = length(d);
        if (r <= shape.z) {
            sum += (place.w * airProfile(r, shape.x, shape.y)) * d;
        }
    }
#endif
#ifdef RELIEF_HAS_VORTICES
    for (int i = 0; i < air_count.y; ++i) {
        vec4 place = air_vortex[3 * i];
        vec4 line = air_vortex[3 * i + 1];
        vec3 d = p - place.xyz;
        vec3 across = d - dot(d, line.xyz) * line.xyz;
        sum += (place.w * airProfile(length(across), line.w, air_vortex[3 * i + 2].x)) *
               cross(line.xyz, across);
    }
#endif
    return sum;
}
