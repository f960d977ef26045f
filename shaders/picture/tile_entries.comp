// SPDX-License-Identifier: Apache-2.0
// Writes an entry for each tile of each sprite.
//!include picture/radix.glsl
//!include picture/tile.glsl
layout(std430, binding = 0) readonly buffer Sprites { uvec4 b_sprites[]; };
layout(std430, binding = 1) writeonly buffer Entries { uvec2 b_entries[]; };
layout(std430, binding = 2) readonly buffer Counts { uint b_counts[]; };
layout(std430, binding = 3) readonly buffer Work { uint b_work[RELIEF_TILE_WORDS]; };

void main() {
    uint rank = gl_WorkGroupID.x * uint(RELIEF_RADIX_DIGITS) + gl_LocalInvocationIndex;
    uvec2 tiles = rank < u_count ? b_sprites[3u * rank + 2u].xy : NO_TILES;
    uint at = b_counts[gl_WorkGroupID.x] + sumBefore(tileCount(tiles));
    if (b_work[0] == 0u) {
        return;
    }
    uvec4 t = unpackTiles(tiles);
    for (uint y = t.y; y <= t.w; ++y) {
        for (uint x = t.x; x <= t.z; ++x) {
            b_entries[at++] = uvec2(rank, y * uint(u_tiles.x) + x);
        }
    }
}
