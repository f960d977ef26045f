// SPDX-License-Identifier: Apache-2.0
// Copies the surface motion of a map from DepthMapRenderer's textures (depth_map_renderer.h) to those of collider.glsl.
uniform highp sampler2D u_motion_xy;  // x of both surfaces, then y
uniform highp sampler2D u_motion_z;
uniform highp usampler2D u_texels;  // depth codes of the surfaces in z and w
uniform ivec2 u_origin;  // of the target rectangle: the rows of the front, then those of the back
uniform int u_height;    // of the map

layout(location = 0) out vec4 o_motion;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy) - u_origin;
    bool front = texel.y < u_height;
    texel.y -= front ? 0 : u_height;
    uvec4 codes = texelFetch(u_texels, texel, 0);
    if ((front ? codes.z : codes.w) == 0u) {
        discard;  // its motion is never read, and most of a box is empty
    }
    vec4 xy = texelFetch(u_motion_xy, texel, 0);
    vec4 z = texelFetch(u_motion_z, texel, 0);
    o_motion = front ? vec4(xy.x, xy.z, z.x, 0.0) : vec4(xy.y, xy.w, z.y, 0.0);
}
