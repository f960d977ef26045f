// For `relief-bench step` alone: the least that a step of two state textures can be.
uniform highp sampler2D u_position;
uniform highp sampler2D u_velocity;

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_velocity;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    o_position = texelFetch(u_position, at, 0);
    o_velocity = texelFetch(u_velocity, at, 0);
}
