// SPDX-License-Identifier: Apache-2.0
// Copies colour and depth of a stored picture to the bound framebuffer, pixel by pixel.
//!include base/srgb.glsl
uniform highp sampler2D u_color;
uniform highp sampler2D u_depth_texture;
uniform bool u_srgb;     // the target stores sRGB values

layout(location = 0) out vec4 o_color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    o_color = texelFetch(u_color, at, 0);
    if (u_srgb) {
        o_color.rgb = srgbOf(clamp(o_color.rgb, 0.0, 1.0));
    }
    gl_FragDepth = texelFetch(u_depth_texture, at, 0).r;
}
