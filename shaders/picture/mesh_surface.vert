// SPDX-License-Identifier: Apache-2.0
// Transforms a mesh into the world.
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec4 a_color;  // sRGB, and how much snow stays there

uniform bool u_colored;  // a_color is valid
uniform vec3 u_clay;     // sRGB, used otherwise
uniform mat4 u_place;  // a rotation, a uniform scale and a translation
uniform mat4 u_clip;   // world to clip space

out vec3 v_normal;
out vec4 v_color;

void main() {
    v_normal = mat3(u_place) * a_normal;
    v_color = u_colored ? a_color : vec4(u_clay, 1.0);
    gl_Position = u_clip * (u_place * vec4(a_position, 1.0));
}
