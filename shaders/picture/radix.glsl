// SPDX-License-Identifier: Apache-2.0
// A stable sort by digits of RELIEF_RADIX_DIGITS values, the least one first (LSD radix sort): for each digit of the
// keys radix_count.comp counts each value by blocks, radix_scan.comp makes of that the places where the elements of each
// value and block begin, and radix_move.comp moves them there. No two invocations store the same word but by sums and
// unions of whole numbers, so the result is deterministic.
//
// Elements are x: index of a particle, y: its key (sort_key.glsl). The greatest key comes first, so digits are those of
// its complement. A block is u_turns rows of one element an invocation.
//!include base/group_barrier.glsl
layout(local_size_x = RELIEF_RADIX_DIGITS) in;

uniform uint u_count;   // elements; with RELIEF_RADIX_COUNTED it is the word behind b_totals' sums
uniform uint u_turns;   // rows of a block
uniform uint u_blocks;
uniform uint u_shift;   // of the digit, bits

uint digitOf(uint key) {
    return (~key >> u_shift) & uint(RELIEF_RADIX_DIGITS - 1);
}

/// The element of this invocation in a row of its block; may lie beyond u_count.
uint elementIn(uint turn) {
    return (gl_WorkGroupID.x * u_turns + turn) * uint(RELIEF_RADIX_DIGITS) + gl_LocalInvocationIndex;
}

#if defined(RELIEF_RADIX_COUNTED)
#define elementCount() b_totals[RELIEF_RADIX_DIGITS]
#else
#define elementCount() u_count
#endif

/// Where u_blocks counts of a digit begin.
uint countsOf(uint digit) {
    return digit * u_blocks;
}

shared uint s_sums[RELIEF_RADIX_DIGITS];

/// The sum over the invocations of the group that come before this one.
uint sumBefore(uint mine) {
    uint self = gl_LocalInvocationIndex;
    s_sums[self] = mine;
    for (uint reach = 1u; reach < uint(RELIEF_RADIX_DIGITS); reach *= 2u) {
        groupBarrier();
        uint other = self >= reach ? s_sums[self - reach] : 0u;
        groupBarrier();
        s_sums[self] += other;
    }
    return s_sums[self] - mine;
}
