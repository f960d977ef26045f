// SPDX-License-Identifier: Apache-2.0
// The sort key of a particle: the bits of its squared distance to the eye, which are ordered like the distance; 0 for
// dead particles.
//
// Comparing keys as uints gives the same order on every machine: no NaN, flushed denormals or fused multiplications
// interfere.
uniform highp sampler2D u_position;
uniform int u_width;  // texels per row of u_position
uniform vec3 u_eye;

uint sortKey(int index) {
    vec4 position = texelFetch(u_position, ivec2(index % u_width, index / u_width), 0);
    if (position.w < 0.0) {
        return 0u;
    }
    vec3 away = position.xyz - u_eye;
    return max(floatBitsToUint(dot(away, away)), 1u);
}
