// SPDX-License-Identifier: Apache-2.0
// Draws footprints: the parts of figures at most u_sole above their ground, seen in the zenith map's projection.
uniform highp sampler2D u_zenith;
uniform float u_sole;  // window depth

layout(location = 0) out vec4 o_print;

void main() {
    float ground = texelFetch(u_zenith, ivec2(gl_FragCoord.xy), 0).r;
    if (ground - gl_FragCoord.z > u_sole || gl_FragCoord.z > ground + u_sole) {
        discard;
    }
    o_print = vec4(1.0);
}
