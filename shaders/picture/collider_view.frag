// SPDX-License-Identifier: Apache-2.0
// Renders the collider from its depth maps, on an infinite floor. Each pixel's ray is traced through the combined field
// in two passes (trace.glsl).
//
// With RELIEF_MESH the collider's mesh was rendered before and provides position and normal; the field only casts
// shadows.
//!include picture/trace.glsl

in vec2 v_uv;

uniform vec3 u_eye;
uniform vec3 u_forward;     // the pixel's ray is eye + t (forward + x right + y up), t = distance along forward
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec2 u_depth;       // window depth of view distance t: x + y / t
uniform float u_ground;     // height of the floor
uniform bool u_has_ground;
uniform vec3 u_background;  // linear
uniform vec3 u_clay;        // linear
uniform int u_normals;      // number averaged for shading: 1, 7 or 13

#if defined(RELIEF_COARSE)
layout(location = 0) out float o_distance;  // along forward; -1: no hit
#else
layout(location = 0) out vec4 o_color;
#endif
#if defined(RELIEF_MESH)
uniform highp sampler2D u_mesh_normal;      // see ColliderMesh::View
uniform highp sampler2D u_mesh_depth;
#endif

// The ray of this pixel: its direction, its distance to the floor, and its part inside the bounds and above the floor.
vec3 rayDirection() {
    vec2 at = 2.0 * v_uv - 1.0;
    return u_forward + at.x * u_right + at.y * u_up;
}
float floorDistance(vec3 d) {
    return u_has_ground && d.y < 0.0 ? (u_ground - u_eye.y) / d.y : -1.0;
}
vec2 raySpan(vec3 d, float t_floor) {
    return clipToBounds(u_eye, d, 0.0, t_floor > 0.0 ? t_floor : 1e30);
}

#ifdef RELIEF_COARSE

void main() {
    vec3 d = rayDirection();
    vec2 span = raySpan(d, floorDistance(d));
    o_distance = span.x < span.y ? hit(u_eye, d, span) : -1.0;
    if (o_distance == -2.0) {
        o_distance = span.x;
    }
}

#else

#ifdef RELIEF_MESH

// Returns the view distance of the mesh at this pixel if it is in front of the floor.
float meshHit(float t_floor) {
    float depth = texelFetch(u_mesh_depth, ivec2(gl_FragCoord.xy), 0).r;
    float t = u_depth.y / (depth - u_depth.x);
    return depth < 1.0 && (t_floor <= 0.0 || t < t_floor) ? t : -1.0;
}
vec3 meshNormal(vec3 to_eye) {
    vec3 n = texelFetch(u_mesh_normal, ivec2(gl_FragCoord.xy), 0).xyz;
    return dot(n, n) > 1e-6 ? normalize(n) : to_eye;
}

#else

// Averages the maps' normals, constant within a texel, over a few texels around p for smooth shading.
vec3 smoothNormal(vec3 p, vec3 to_eye) {
    vec3 n = to_eye;
    vec3 a, b;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < u_normals; ++i) {
        // The centre first, then six on a ring, then six on a second ring.
        vec3 q = p;
        if (i > 0) {
            float ring = float((i + 5) / 6);
            float angle = TWO_PI * (float(i) + 0.5 * ring) / 6.0;
            q += (0.9 * ring * u_texel) * (cos(angle) * a + sin(angle) * b) - (0.35 * u_texel) * n;
        }
        vec3 other = reliefEvaluate(q).normal;
        if (i == 0) {
            n = dot(other, other) > 0.5 ? other : to_eye;
            other = n;
            basis(n, a, b);
        }
        // Across a crease the average would be wrong for both sides.
        sum += other * smoothstep(0.3, 0.8, dot(other, n));
    }
    return normalize(sum);
}

#endif

void main() {
    vec3 d = rayDirection();
    uint seed = uint(gl_FragCoord.x) * 1973u + uint(gl_FragCoord.y) * 9277u + 26699u;
    noise(seed);

    // A soft gradient, lighter at the bottom; a fully lit floor has the same colour.
    vec3 color = u_background * mix(1.16, 0.70, smoothstep(0.0, 1.0, v_uv.y));

    float t_floor = floorDistance(d);
#ifdef RELIEF_MESH
    float t = meshHit(t_floor);
#else
    vec2 span = raySpan(d, t_floor);
    float t = span.x < span.y ? guidedHit(v_uv, u_eye, d, span) : -1.0;
#endif
    bool on_collider = t > 0.0;
    bool on_floor = !on_collider && t_floor > 0.0;
    float at = on_collider ? t : t_floor;
    vec3 p = u_eye + at * d;
    vec3 to_eye = -normalize(d);
    float away = length(p.xz - 0.5 * (u_bounds_min.xz + u_bounds_max.xz)) / u_scale;
    float fade = 1.0 - smoothstep(2.0, 5.0, away);

    if (on_collider || (on_floor && fade > 0.0)) {
        vec3 n = vec3(0.0, 1.0, 0.0);
        vec3 start = p + (0.75 * u_texel) * n;
        if (on_collider) {
#ifdef RELIEF_MESH
            n = meshNormal(to_eye);
#else
            n = smoothNormal(p, to_eye);
#endif
            start = p + (1.5 * u_texel) * n + (0.5 * u_texel) * to_eye;
        }
        float sun;
        vec3 sky;
        receive(start, n, seed, sun, sky);
        if (on_collider) {
            // The sunlight wraps around slightly, as on clay.
            float key = max((dot(n, u_sun) + 0.12) / 1.12, 0.0);
            float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 4.0);
            color = u_clay * (0.86 * key * sun * SUN_COLOR + sky) + 0.05 * rim * SKY_COLOR;
        } else {
            vec3 open = u_sun.y * SUN_COLOR + skylightOpen();
            color *= mix(vec3(1.0), (u_sun.y * sun * SUN_COLOR + sky) / open, fade);
        }
    }
    float depth = on_collider || on_floor ? u_depth.x + u_depth.y / at : 1.0;
    o_color = vec4(color, 1.0);
    gl_FragDepth = clamp(depth, 0.0, 1.0);
}

#endif
