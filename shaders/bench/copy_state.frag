// SPDX-License-Identifier: Apache-2.0
// For `relief-bench step`: the minimum work of a step, copying two state textures.
uniform highp sampler2D u_position;
uniform highp sampler2D u_velocity;

#if defined(RELIEF_COMPUTE)

layout(local_size_x = RELIEF_STEP_GROUP_WIDTH, local_size_y = RELIEF_STEP_GROUP_HEIGHT) in;
layout(rgba32f, binding = 0) writeonly uniform highp image2D u_position_out;
layout(rgba32f, binding = 1) writeonly uniform highp image2D u_velocity_out;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageStore(u_position_out, at, texelFetch(u_position, at, 0));
    imageStore(u_velocity_out, at, texelFetch(u_velocity, at, 0));
}

#else

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_velocity;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    o_position = texelFetch(u_position, at, 0);
    o_velocity = texelFetch(u_velocity, at, 0);
}

#endif
