// SPDX-License-Identifier: Apache-2.0
// Writes births: one fragment per particle.
flat in vec3 v_position;
flat in vec3 v_velocity;
flat in vec4 v_birth;

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_velocity;
layout(location = 2) out vec4 o_birth;

void main() {
    o_position = vec4(v_position, 0.0);
    o_velocity = vec4(v_velocity, 0.0);
    o_birth = v_birth;
}
