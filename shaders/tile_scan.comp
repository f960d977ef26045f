// One work group: where the entries of each group of sprites begin; and whether there is room for all.
//!include radix.glsl
//!include radix_sum.glsl
layout(std430, binding = 2) buffer Counts { uint b_counts[]; };  // of u_blocks groups
layout(std430, binding = 3) writeonly buffer Work { uint b_work[RELIEF_TILE_WORDS]; };

uniform uint u_room;      // entries, less than MOST
uniform uint u_vertices;  // of a sprite

// An invocation's sum counts no further, so that theirs together are no more than 32 bits; this many have no room anyway.
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
