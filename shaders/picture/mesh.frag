// SPDX-License-Identifier: Apache-2.0
// Writes the normal of the mesh at each pixel; collider_view.frag shades it.
in vec3 v_normal;

layout(location = 0) out vec4 o_normal;

void main() {
    // Both sides are visible.
    o_normal = vec4(gl_FrontFacing ? v_normal : -v_normal, 1.0);
}
