// Sums over squares of texels, one fragment each, or with RELIEF_COMPUTE three passes of them in a work group: shared by
// reduce_state.frag and reduce_sum.frag. Both add the same numbers in the same order.
//
//     counts   x particles alive   y collided   z caught   w half the sum of |v|^2
//     sums     x, y collisions = x + RELIEF_COLLISIONS_HIGH y   z greatest |v|^2
//              w RELIEF_TYPE_CODES - the first type of which a particle is lost; 0 if none is
//
// Counts are whole numbers below 2^24, which floats hold exactly. The collisions of all particles go beyond; in
// two parts they are exact up to 2^36.

uniform ivec2 u_size;  // of the summed texture, texels

struct Sums {
    vec4 counts;
    vec4 sums;
};

// Of one texel, which lies within u_size.
Sums sumsAt(ivec2 texel);

#if defined(RELIEF_COMPUTE)
//!include base/group_barrier.glsl
layout(local_size_x = RELIEF_REDUCED_GROUP, local_size_y = RELIEF_REDUCED_GROUP) in;
layout(std430, binding = 0) writeonly buffer Reduced { Sums b_reduced[]; };

// Results of the passes of a group: rows of RELIEF_REDUCED_GROUP, and of RELIEF_REDUCED_SIDE.
shared Sums s_first[RELIEF_REDUCED_GROUP * RELIEF_REDUCED_GROUP];
shared Sums s_second[RELIEF_REDUCED_GROUP];
#endif

// Of a square of texels or, from pass 1 on, of results of the pass before.
Sums squareAt(int pass, ivec2 square) {
    vec4 counts = vec4(0.0);
    vec4 sums = vec4(0.0);
    for (int y = 0; y < RELIEF_REDUCED_SIDE; ++y) {
        // A row first, then the rows: fewer roundings in a chain.
        vec4 row = vec4(0.0);
        for (int x = 0; x < RELIEF_REDUCED_SIDE; ++x) {
            ivec2 at = RELIEF_REDUCED_SIDE * square + ivec2(x, y);
            Sums one;
#if defined(RELIEF_COMPUTE)
            if (pass == 1) {
                one = s_first[at.y * RELIEF_REDUCED_GROUP + at.x];
            } else if (pass == 2) {
                one = s_second[at.y * RELIEF_REDUCED_SIDE + at.x];
            } else
#endif
            if (at.x < u_size.x && at.y < u_size.y) {
                one = sumsAt(at);
            } else {
                continue;
            }
            row += one.counts;
            sums.xy += one.sums.xy;
            sums.zw = max(sums.zw, one.sums.zw);
        }
        counts += row;
    }
    float carry = floor(sums.x / float(RELIEF_COLLISIONS_HIGH));
    return Sums(counts, vec4(sums.x - float(RELIEF_COLLISIONS_HIGH) * carry, sums.y + carry, sums.zw));
}

#if !defined(RELIEF_COMPUTE)

layout(location = 0) out vec4 o_counts;
layout(location = 1) out vec4 o_sums;

void main() {
    Sums square = squareAt(0, ivec2(gl_FragCoord.xy));
    o_counts = square.counts;
    o_sums = square.sums;
}

#else

void main() {
    int self = int(gl_LocalInvocationIndex);
    s_first[self] = squareAt(0, ivec2(gl_GlobalInvocationID.xy));
    groupBarrier();
    if (self < RELIEF_REDUCED_GROUP) {
        s_second[self] = squareAt(1, ivec2(self % RELIEF_REDUCED_SIDE, self / RELIEF_REDUCED_SIDE));
    }
    groupBarrier();
    if (self == 0) {
        b_reduced[gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x] = squareAt(2, ivec2(0));
    }
}

#endif
