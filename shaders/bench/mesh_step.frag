// SPDX-License-Identifier: Apache-2.0
// A step with the exact signed distance of a triangle mesh in place of depth maps: the rival of
// `relief-bench step --exact`. Everything except the solid is shared with particles/step.frag.
//!include particles/step.glsl
//!include bench/mesh_tree.glsl

uniform vec3 u_box_min;  // of the mesh
uniform vec3 u_box_max;

vec3 g_to;  // the last point passed to solid()

// Returns the signed distance. The caller only needs it if the squared distance is below `within2`.
float distanceAt(vec3 p, float within2, out vec3 normal) {
    float distance = RELIEF_FAR_OUTSIDE;
    normal = vec3(0.0);
    if (all(greaterThanEqual(p, u_box_min)) && all(lessThanEqual(p, u_box_max))) {
        distance = meshDistance(closestPoint(p, within2), normal);
    }
    return distance;
}

Solid solid(vec3 p, float radius) {
    vec3 normal;
    float distance = distanceAt(p, RELIEF_UNBOUNDED, normal);
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
