// SPDX-License-Identifier: Apache-2.0
// One group per digit: replaces its counts by the sums over preceding blocks, and writes the total to b_totals.
//!include picture/radix.glsl
layout(std430, binding = 2) buffer Counts { uint b_counts[]; };
layout(std430, binding = 3) writeonly buffer Totals { uint b_totals[]; };

void main() {
    uint each = (u_blocks + uint(RELIEF_RADIX_DIGITS - 1)) / uint(RELIEF_RADIX_DIGITS);
    uint first = gl_LocalInvocationIndex * each;
    uint last = min(first + each, u_blocks);
    uint at = countsOf(gl_WorkGroupID.x);
    uint mine = 0u;
    for (uint block = first; block < last; ++block) {
        mine += b_counts[at + block];
    }
    uint sum = sumBefore(mine);
    if (gl_LocalInvocationIndex == uint(RELIEF_RADIX_DIGITS - 1)) {
        b_totals[gl_WorkGroupID.x] = sum + mine;
    }
    for (uint block = first; block < last; ++block) {
        uint count = b_counts[at + block];
        b_counts[at + block] = sum;
        sum += count;
    }
}
