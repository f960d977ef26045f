// SPDX-License-Identifier: Apache-2.0
// The collider's mesh, in object space.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;

uniform mat4 u_clip;  // object space to clip space

out vec3 v_normal;

void main() {
    v_normal = a_normal;
    gl_Position = u_clip * vec4(a_position, 1.0);
}
