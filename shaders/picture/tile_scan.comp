// SPDX-License-Identifier: Apache-2.0
// In one work group: computes the first entry of each group of sprites, and whether there is room for all.
//!include picture/radix.glsl
layout(std430, binding = 2) buffer Counts { uint b_counts[]; };  // for u_blocks groups
layout(std430, binding = 3) writeonly buffer Work { uint b_work[RELIEF_TILE_WORDS]; };

uniform uint u_room;      // entries, less than MOST
uniform uint u_vertices;  // per sprite

// Each invocation stops counting here, so that all sums fit into 32 bits; there is no room for that many anyway.
const uint MOST = 0xffffffu;

void main() {
    uint self = gl_LocalInvocationIndex;
    uint each = (u_blocks + uint(RELIEF_RADIX_DIGITS - 1)) / uint(RELIEF_RADIX_DIGITS);
    uint first = self * each;
    uint last = min(first + each, u_blocks);
    uint mine = 0u;
    for (uint block = first; block < last; ++block) {
        mine = min(mine + min(b_counts[block], MOST), MOST);
    }
    uint sum = sumBefore(mine);
    if (self == uint(RELIEF_RADIX_DIGITS - 1)) {
        bool fits = sum + mine <= u_room;
        b_work[0] = fits ? sum + mine : 0u;
        b_work[1] = fits ? 0u : u_count * u_vertices;
        b_work[2] = 1u;
        b_work[3] = 0u;
        b_work[4] = 0u;
        b_work[5] = u_count * u_vertices;
        b_work[6] = 0u;
    }
    for (uint block = first; block < last; ++block) {
        uint count = b_counts[block];
        b_counts[block] = sum;
        sum += count;
    }
}
