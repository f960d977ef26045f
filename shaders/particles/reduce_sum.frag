// A further pass of the statistics: a square of the pass before.
//!include particles/reduce.glsl

uniform highp sampler2D u_counts;
uniform highp sampler2D u_sums;

Sums sumsAt(ivec2 texel) {
    return Sums(texelFetch(u_counts, texel, 0), texelFetch(u_sums, texel, 0));
}
