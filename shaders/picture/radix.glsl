// SPDX-License-Identifier: Apache-2.0
// A stable LSD radix sort by digits of RELIEF_RADIX_DIGITS values. For each digit, radix_count.comp counts each value
// in each block, radix_scan.comp computes where the elements of each value and block begin, and radix_move.comp moves
// them there. Concurrent writes to one word are only integer sums and bitwise ORs, so the result is deterministic.
//
// Elements are x: index of a particle, y: its key (sort_key.glsl). The largest key comes first, so digits are taken
// from the complement of the key. A block has u_turns rows with one element per invocation.
//!include base/group_barrier.glsl
layout(local_size_x = RELIEF_RADIX_DIGITS) in;

uniform uint u_count;   // elements; with RELIEF_RADIX_COUNTED their number follows the sums in b_totals
uniform uint u_turns;   // rows per block
uniform uint u_blocks;
uniform uint u_shift;   // bit position of the digit

uint digitOf(uint key) {
    return (~key >> u_shift) & uint(RELIEF_RADIX_DIGITS - 1);
}

/// Returns the element of this invocation in a row of its block; may be beyond u_count.
uint elementIn(uint turn) {
    return (gl_WorkGroupID.x * u_turns + turn) * uint(RELIEF_RADIX_DIGITS) + gl_LocalInvocationIndex;
}

#if defined(RELIEF_RADIX_COUNTED)
#define elementCount() b_totals[RELIEF_RADIX_DIGITS]
#else
#define elementCount() u_count
#endif

/// Returns where the u_blocks counts of a digit begin.
uint countsOf(uint digit) {
    return digit * u_blocks;
}

shared uint s_sums[RELIEF_RADIX_DIGITS];

/// Returns the sum over the preceding invocations of the group.
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
