// SPDX-License-Identifier: Apache-2.0
// Moves the elements of each block to the positions of their digits, in stable order. The pass of the last digit writes
// to the order texture.
//!include picture/radix.glsl
layout(std430, binding = 0) readonly buffer From { uvec2 b_from[]; };
#if defined(RELIEF_RADIX_LAST)
layout(RELIEF_RADIX_FORMAT, binding = 0) writeonly uniform highp uimage2D u_to;
#else
layout(std430, binding = 1) writeonly buffer To { uvec2 b_to[]; };
#endif
layout(std430, binding = 2) readonly buffer Counts { uint b_counts[]; };
layout(std430, binding = 3) readonly buffer Totals { uint b_totals[]; };

const uint kWords = uint(RELIEF_RADIX_DIGITS / 32);

// A bit for each invocation whose element has the digit, word by word; invocation d manages digit d.
shared uint s_flags[RELIEF_RADIX_DIGITS / 32][RELIEF_RADIX_DIGITS];
shared uint s_next[RELIEF_RADIX_DIGITS];  // rank of the next element with the digit

void store(uint rank, uvec2 element) {
#if defined(RELIEF_RADIX_LAST)
    imageStore(u_to, ivec2(rank % uint(RELIEF_ORDER_WIDTH), rank / uint(RELIEF_ORDER_WIDTH)), uvec4(element, 0u, 0u));
#else
    b_to[rank] = element;
#endif
}

/// Returns the number of preceding invocations with the same digit.
uint before(uint digit, uint word, uint flag) {
    uint sum = uint(bitCount(s_flags[word][digit] & (flag - 1u)));
    for (uint i = 0u; i < word; ++i) {
        sum += uint(bitCount(s_flags[i][digit]));
    }
    return sum;
}

/// Returns the number of invocations with the digit that this invocation manages, and clears its flags.
uint takeFlags(uint self) {
    uint sum = 0u;
    for (uint i = 0u; i < kWords; ++i) {
        sum += uint(bitCount(s_flags[i][self]));
        s_flags[i][self] = 0u;
    }
    return sum;
}

void main() {
    uint self = gl_LocalInvocationIndex;
    uint word = self / 32u;
    uint flag = 1u << (self % 32u);
    s_next[self] = sumBefore(b_totals[self]) + b_counts[countsOf(self) + gl_WorkGroupID.x];
    for (uint i = 0u; i < kWords; ++i) {
        s_flags[i][self] = 0u;
    }
    groupBarrier();
    for (uint turn = 0u; turn < u_turns; ++turn) {
        uint at = elementIn(turn);
        uvec2 element = uvec2(0u);
        uint digit = 0u;
        if (at < elementCount()) {
            element = b_from[at];
            digit = digitOf(element.y);
            atomicOr(s_flags[word][digit], flag);
        }
        groupBarrier();
        if (at < elementCount()) {
            store(s_next[digit] + before(digit, word, flag), element);
        }
        groupBarrier();
        s_next[self] += takeFlags(self);
        groupBarrier();
    }
}
