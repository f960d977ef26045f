// Deforms the vertices of a mesh at rest, for transform feedback; nothing is rasterised. The C++ twin is
// runtime/collider/deformation.cpp, explained in its header.
layout(location = 0) in vec3 a_position;  // object space, at rest
layout(location = 1) in vec3 a_normal;    // of length 1, or zero

uniform vec4 u_row[3];   // of an affine map after the deformation: the identity, or object to world
uniform float u_inch;    // reach of the differences for normals, object units

out vec3 v_position;
#if defined(RELIEF_DEFORM_NORMALS)
out vec3 v_normal;
#endif

uniform int u_kind;  // DeformKind
uniform float u_angle;      // radians, at this moment
uniform vec3 u_phases;      // of the waves of a wobble
uniform float u_amplitude;  // of a wobble, object units
uniform float u_number;     // 2 pi / wavelength
uniform vec3 u_center;
uniform vec3 u_axis;
uniform vec3 u_along;
uniform vec2 u_range;

float sinc(float x) {
    return abs(x) < 1e-2 ? 1.0 - x * x / 6.0 : sin(x) / x;
}

vec3 turn(vec3 p, vec3 axis, float angle) {
    float c = cos(angle);
    return c * p + sin(angle) * cross(axis, p) + (1.0 - c) * dot(axis, p) * axis;
}

vec3 deformed(vec3 p) {
    vec3 q = p - u_center;
    float span = u_range.y - u_range.x;
    if (u_kind == RELIEF_DEFORM_KIND_BEND) {
        float inside = clamp(dot(q, u_along), u_range.x, u_range.y);
        float arc = inside - u_range.x;
        float a = u_angle * arc / span;
        vec3 side = cross(u_axis, u_along);
        vec3 line = u_range.x * u_along +
                    arc * sinc(0.5 * a) * (cos(0.5 * a) * u_along + sin(0.5 * a) * side);
        return u_center + line + turn(q - inside * u_along, u_axis, a);
    }
    if (u_kind == RELIEF_DEFORM_KIND_TWIST) {
        float share = (clamp(dot(q, u_axis), u_range.x, u_range.y) - u_range.x) / span;
        return u_center + turn(q, u_axis, u_angle * share);
    }
    vec3 waves = sin(u_number * p + u_phases);
    return p + u_amplitude / 3.0 * (waves.x + waves.y + waves.z) * a_normal;
}

vec3 placed(vec3 p) {
    return vec3(dot(u_row[0].xyz, p) + u_row[0].w, dot(u_row[1].xyz, p) + u_row[1].w,
                dot(u_row[2].xyz, p) + u_row[2].w);
}

void main() {
    v_position = placed(deformed(a_position));
#if defined(RELIEF_DEFORM_NORMALS)
    // Two directions across the normal, deformed.
    vec3 n = a_normal;
    vec3 u = abs(n.x) < 0.6 ? vec3(0.0, n.z, -n.y) : vec3(-n.z, 0.0, n.x);
    float l = length(u);
    u = l > 0.0 ? u / l : vec3(0.0);
    vec3 v = cross(n, u);
    vec3 du = placed(deformed(a_position + u_inch * u)) - placed(deformed(a_position - u_inch * u));
    vec3 dv = placed(deformed(a_position + u_inch * v)) - placed(deformed(a_position - u_inch * v));
    vec3 across = cross(du, dv);
    float size = length(across);
    v_normal = size > 0.0 ? across / size : n;
#endif
    gl_Position = vec4(0.0);
}
