// SPDX-License-Identifier: Apache-2.0
// Renders the collider seen from the sun, along parallel rays from a plane on the sun's side, in two passes
// (trace.glsl), for particle_light.glsl. Parts thinner than four texels perpendicular to the rays may be missed.
//!include picture/trace.glsl

in vec2 v_uv;

uniform vec3 u_corner;  // corner of texel (0, 0), on the plane where the rays start
uniform vec3 u_across;  // from there to the other corners, object units
uniform vec3 u_along;

layout(location = 0) out float o_distance;  // from the plane to the collider. Coarse pass: -1 for no hit

void main() {
    vec3 origin = u_corner + v_uv.x * u_across + v_uv.y * u_along;
    vec2 span = clipToBounds(origin, -u_sun, 0.0, 1e30);
#if defined(RELIEF_COARSE)
    float t = span.x < span.y ? hit(origin, -u_sun, span) : -1.0;
    o_distance = t == -2.0 ? span.x : t;
#else
    float t = span.x < span.y ? guidedHit(v_uv, origin, -u_sun, span) : -1.0;
    o_distance = t < 0.0 ? RELIEF_NO_SHADE : t;
#endif
}
