// air.glsl at the points of a texture, one a texel: for tests against its C++ twin.
//!include air/air.glsl
uniform highp sampler2D u_points;    // xyz: object space; w: time
uniform highp sampler2D u_velocity;  // xyz: the particle's velocity; w: its radius
uniform float u_viscosity;
uniform float u_mass;

layout(location = 0) out vec4 o_air;    // xyz: airVelocity
layout(location = 1) out vec4 o_field;  // xyz: fieldAcceleration; w: stokesRate

void main() {
    vec4 point = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0);
    vec4 particle = texelFetch(u_velocity, ivec2(gl_FragCoord.xy), 0);
    o_air = vec4(airVelocity(point.xyz, point.w), 0.0);
    o_field = vec4(fieldAcceleration(point.xyz, particle.xyz, point.w),
                   stokesRate(u_viscosity, particle.w, u_mass));
}
