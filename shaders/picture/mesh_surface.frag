// SPDX-License-Identifier: Apache-2.0
// Writes colour and normal of the meshes at each pixel; mesh_shade.frag shades them.
in vec3 v_normal;
in vec4 v_color;

layout(location = 0) out vec4 o_color;
layout(location = 1) out vec4 o_normal;

void main() {
    o_color = v_color;
    // Both sides are visible.
    o_normal = vec4(gl_FrontFacing ? v_normal : -v_normal, 1.0);
}
