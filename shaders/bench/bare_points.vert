// SPDX-License-Identifier: Apache-2.0
// The cheapest way to draw particles, as points with the size of their sprites: the baseline of `relief-bench picture`.
uniform highp sampler2D u_position;
uniform mat4 u_clip;
uniform float u_pixels;  // size of a sprite at view distance 1
uniform float u_pixels_min;

void main() {
    int width = textureSize(u_position, 0).x;
    vec4 position = texelFetch(u_position, ivec2(gl_VertexID % width, gl_VertexID / width), 0);
    gl_Position = u_clip * vec4(position.xyz, 1.0);
    gl_PointSize = max(u_pixels / gl_Position.w, u_pixels_min);
}
