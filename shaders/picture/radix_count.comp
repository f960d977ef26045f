// SPDX-License-Identifier: Apache-2.0
// Counts the digits of each block. The pass of the first digit also creates the elements, in order of index.
//!include picture/radix.glsl
#if defined(RELIEF_RADIX_FIRST)
//!include picture/sort_key.glsl
layout(std430, binding = 0) writeonly buffer Elements { uvec2 b_elements[]; };
#else
layout(std430, binding = 0) readonly buffer Elements { uvec2 b_elements[]; };
#endif
layout(std430, binding = 2) writeonly buffer Counts { uint b_counts[]; };
#if defined(RELIEF_RADIX_COUNTED)
layout(std430, binding = 3) readonly buffer Totals { uint b_totals[]; };
#endif

shared uint s_counts[RELIEF_RADIX_DIGITS];

uint keyOf(uint element) {
#if defined(RELIEF_RADIX_FIRST)
    uint key = sortKey(int(element));
    b_elements[element] = uvec2(element, key);
    return key;
#else
    return b_elements[element].y;
#endif
}

void main() {
    uint self = gl_LocalInvocationIndex;
    s_counts[self] = 0u;
    groupBarrier();
    for (uint turn = 0u; turn < u_turns; ++turn) {
        uint element = elementIn(turn);
        if (element < elementCount()) {
            atomicAdd(s_counts[digitOf(keyOf(element))], 1u);
        }
    }
    groupBarrier();
    b_counts[countsOf(self) + gl_WorkGroupID.x] = s_counts[self];
}
