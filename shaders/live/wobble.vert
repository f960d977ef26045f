// SPDX-License-Identifier: Apache-2.0
// Animates the vertices of a mesh with a wobble, for transform feedback; nothing is rasterised.
// runtime/live/wobble_pass.h documents the formula.
layout(location = 0) in vec3 a_position;  // object space, at rest
layout(location = 1) in vec3 a_normal;    // unit length, or zero

uniform float u_step;       // step of the finite differences for normals, object units
uniform vec3 u_phases;      // of the waves, at the current time
uniform float u_amplitude;  // object units
uniform float u_number;     // 2 pi / wavelength

out vec3 v_position;
#if defined(RELIEF_NORMALS)
out vec3 v_normal;
#endif

vec3 moved(vec3 p) {
    vec3 waves = sin(u_number * p + u_phases);
    return p + u_amplitude / 3.0 * (waves.x + waves.y + waves.z) * a_normal;
}

void main() {
    v_position = moved(a_position);
#if defined(RELIEF_NORMALS)
    // Move two directions perpendicular to the normal along with the surface.
    vec3 n = a_normal;
    vec3 u = abs(n.x) < 0.6 ? vec3(0.0, n.z, -n.y) : vec3(-n.z, 0.0, n.x);
    float l = length(u);
    u = l > 0.0 ? u / l : vec3(0.0);
    vec3 v = cross(n, u);
    vec3 du = moved(a_position + u_step * u) - moved(a_position - u_step * u);
    vec3 dv = moved(a_position + u_step * v) - moved(a_position - u_step * v);
    vec3 across = cross(du, dv);
    float size = length(across);
    v_normal = size > 0.0 ? across / size : n;
#endif
    gl_Position = vec4(0.0);
}
