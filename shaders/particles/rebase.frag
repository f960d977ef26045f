// SPDX-License-Identifier: Apache-2.0
// Moves the origin of the clock, so that times stay small enough for a float: shifts both times in the birth texture.
uniform highp sampler2D u_birth;
uniform float u_shift;  // seconds

layout(location = 0) out vec4 o_birth;

void main() {
    vec4 birth = texelFetch(u_birth, ivec2(gl_FragCoord.xy), 0);
    o_birth = vec4(birth.x - u_shift, birth.y - u_shift, birth.zw);
}
