// SPDX-License-Identifier: Apache-2.0
// One triangle that covers the viewport, computed from gl_VertexID: draw 3 vertices with an empty vertex array.
//
//      (-1,3)                 v_uv runs from (0,0) at the viewport's lower left
//        |\                   to (1,1) at its upper right
//        |_\__
//        |  |\
//   (-1,-1)--(3,-1)
out vec2 v_uv;

void main() {
    vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
    v_uv = corner;
    gl_Position = vec4(2.0 * corner - 1.0, 0.0, 1.0);
}
