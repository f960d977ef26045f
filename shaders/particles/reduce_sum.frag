// A further pass of the statistics: a square of the pass before.
//!include particles/reduce.glsl

#if defined(RELIEF_COMPUTE)

layout(std430, binding = 1) readonly buffer Reducing { Sums b_reducing[]; };

Sums sumsAt(ivec2 texel) {
    return b_reducing[texel.y * u_size.x + texel.x];
}

#else

uniform highp sampler2D u_counts;
uniform highp sampler2D u_sums;

Sums sumsAt(ivec2 texel) {
    return Sums(texelFetch(u_counts, texel, 0), texelFetch(u_sums, texel, 0));
}

#endif
