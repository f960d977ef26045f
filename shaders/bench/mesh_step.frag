// SPDX-License-Identifier: Apache-2.0
// A step with the exact signed distance of a triangle mesh in place of depth maps: the baseline of
// `relief-bench step --exact`. Everything except the solid is shared with particles/step.frag.
//
// With RELIEF_KEPT, a step stores a lower bound of the distance from the surface if the particle is outside. The particle
// stays outside, and needs no query, until it has moved that far. A query then searches only a distance of a few steps:
// if it finds no surface, the particle is still outside. The results equal those without RELIEF_KEPT.
//!include particles/step.glsl
//!include bench/mesh_tree.glsl

uniform vec3 u_box_min;  // of the mesh
uniform vec3 u_box_max;

#if defined(RELIEF_KEPT)

#define RELIEF_SEARCHED_STEPS 4.0

uniform highp sampler2D u_kept;  // lower bound of the distance of a particle outside; negative: side unknown

#if defined(RELIEF_COMPUTE)
layout(r32f, binding = 2) writeonly uniform highp image2D u_kept_out;
#else
layout(location = 2) out float o_kept;
#endif

ivec2 particleTexel() {
#if defined(RELIEF_COMPUTE)
    return ivec2(gl_GlobalInvocationID.xy);
#else
    return ivec2(gl_FragCoord.xy);
#endif
}

// Returns the bound at p, a point on the path of this step. within: distance to search if the bound is not positive.
float keptAt(vec3 p, out float within) {
    ivec2 texel = particleTexel();
    float kept = texelFetch(u_kept, texel, 0).r;
    float moved = 1.0001 * length(p - texelFetch(u_position, texel, 0).xyz) + 1e-6 * length(u_box_max - u_box_min);
    within = kept < 0.0 ? sqrt(RELIEF_UNBOUNDED) : RELIEF_SEARCHED_STEPS * moved;
    return kept - moved;
}

void keep(float distance) {
    float kept = distance < 0.0 ? -1.0 : distance;
#if defined(RELIEF_COMPUTE)
    imageStore(u_kept_out, particleTexel(), vec4(kept));
#else
    o_kept = kept;
#endif
}

#else

float keptAt(vec3 p, out float within) {
    within = sqrt(RELIEF_UNBOUNDED);
    return 0.0;
}

void keep(float distance) {}

#endif

vec3 g_to;  // the last point passed to solid()

// Returns the signed distance if it is less than `within` in magnitude, else `within`. Outside the box of the mesh,
// returns a lower bound.
float distanceAt(vec3 p, float within, out vec3 normal) {
    float distance = length(max(max(u_box_min - p, p - u_box_max), 0.0));
    normal = vec3(0.0);
    if (distance == 0.0) {
        distance = meshDistance(closestPoint(p, within * within), normal);
    }
    return distance;
}

Solid solid(vec3 p, float radius) {
    vec3 normal = vec3(0.0);
    float within;
    float distance = keptAt(p, within);
    if (distance <= 0.0) {
        distance = distanceAt(p, within, normal);
    }
    keep(distance);
    g_to = p;
    return Solid(distance < 0.0 ? distance : RELIEF_FAR_OUTSIDE, normal, 0, 0, vec3(0.0));
}

bool insideBefore(vec3 p, float radius, Solid s, bool free) {
    float moved = 1.0001 * length(p - g_to);
    float depth = -s.distance;
    // A path shorter than the depth of its end is inside.
    bool inside = moved < depth;
    if (!inside) {
        // The surface close to the end of the step bounds the search, with a margin for rounding.
        vec3 normal;
        inside = distanceAt(p, 1.001 * (moved + depth), normal) < 0.0;
    }
    return inside;
}

//!include particles/step_still.glsl
