// SPDX-License-Identifier: Apache-2.0
// Averages factor × factor linear pixels and converts to sRGB.
//!include base/srgb.glsl
uniform highp sampler2D u_color;
uniform int u_factor;

layout(location = 0) out vec4 o_color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) * u_factor;
    vec3 sum = vec3(0.0);
    for (int y = 0; y < u_factor; ++y) {
        for (int x = 0; x < u_factor; ++x) {
            sum += min(texelFetch(u_color, at + ivec2(x, y), 0).rgb, vec3(1.0));
        }
    }
    vec3 c = max(sum / float(u_factor * u_factor), vec3(0.0));
    o_color = vec4(srgbOf(c), 1.0);
}
