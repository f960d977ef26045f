// SPDX-License-Identifier: Apache-2.0
// A step with the exact signed distance of a triangle mesh in place of depth maps: the rival of
// `relief-bench step --exact`. Everything except the solid is shared with particles/step.frag.
//
// With RELIEF_KEPT, a step stores its distance from the surface if the particle is outside. Until the particle has
// moved that far it is still outside, and needs no query.
//!include particles/step.glsl
//!include bench/mesh_tree.glsl

uniform vec3 u_box_min;  // of the mesh
uniform vec3 u_box_max;

#if defined(RELIEF_KEPT)

uniform highp sampler2D u_kept;  // lower bound of the distance of a particle outside; 0: unknown

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

// Returns the bound at p, a point of this step.
float keptAt(vec3 p) {
    ivec2 texel = particleTexel();
    float moved = length(p - texelFetch(u_position, texel, 0).xyz);
    float rounding = 1e-6 * length(u_box_max - u_box_min);
    return texelFetch(u_kept, texel, 0).r - 1.0001 * moved - rounding;
}

void keep(float distance) {
    float kept = max(distance, 0.0);
#if defined(RELIEF_COMPUTE)
    imageStore(u_kept_out, particleTexel(), vec4(kept));
#else
    o_kept = kept;
#endif
}

#else

float keptAt(vec3 p) {
    return 0.0;
}

void keep(float distance) {}

#endif

vec3 g_to;  // the last point passed to solid()

// Returns the signed distance, or a lower bound outside the box of the mesh. Callers only need it if its square is
// below `within2`.
float distanceAt(vec3 p, float within2, out vec3 normal) {
    float distance = length(max(max(u_box_min - p, p - u_box_max), 0.0));
    normal = vec3(0.0);
    if (distance == 0.0) {
        distance = meshDistance(closestPoint(p, within2), normal);
    }
    return distance;
}

Solid solid(vec3 p, float radius) {
    vec3 normal = vec3(0.0);
    float distance = keptAt(p);
    if (distance <= 0.0) {
        distance = distanceAt(p, RELIEF_UNBOUNDED, normal);
    }
    keep(distance);
    g_to = p;
    return Solid(distance < 0.0 ? distance : RELIEF_FAR_OUTSIDE, normal, 0, 0, vec3(0.0));
}

bool insideBefore(vec3 p, float radius, Solid s, bool free) {
    // The surface close to the end of the step bounds the search, with a margin for rounding.
    float within = (length(p - g_to) - s.distance) * 1.001;
    vec3 normal;
    return distanceAt(p, within * within, normal) < 0.0;
}

vec3 pointBefore(Solid s, vec3 p) {
    return p;
}

vec3 pointNow(int body, vec3 p) {
    return p;
}

vec2 bodyResponse(int body) {
    return vec2(1.0);
}
