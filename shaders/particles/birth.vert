// SPDX-License-Identifier: Apache-2.0
// Places births: one point per particle, on the texel of its index.
layout(location = 0) in uint a_index;
layout(location = 1) in vec3 a_position;
layout(location = 2) in vec3 a_velocity;
layout(location = 3) in vec4 a_birth;  // time of birth, time of death, type, id modulo 2^24

uniform ivec2 u_size;  // size of the state textures, texels

flat out vec3 v_position;
flat out vec3 v_velocity;
flat out vec4 v_birth;

void main() {
    int index = int(a_index);
    vec2 texel = vec2(float(index % u_size.x), float(index / u_size.x)) + 0.5;
    gl_Position = vec4(2.0 * texel / vec2(u_size) - 1.0, 0.0, 1.0);
    gl_PointSize = 1.0;
    v_position = a_position;
    v_velocity = a_velocity;
    v_birth = a_birth;
}
