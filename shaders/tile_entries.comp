// Makes an entry of each tile of each sprite.
//!include radix.glsl
//!include radix_sum.glsl
//!include tile.glsl
layout(std430, binding = 0) readonly buffer Sprites { uvec4 b_sprites[]; };
layout(std430, binding = 1) writeonly buffer Entries { uvec2 b_entries[]; };
layout(std430, binding = 2) readonly buffer Counts { uint b_counts[]; };
layout(std430, binding = 3) readonly buffer Work { uint b_work[5]; };

void main() {
    uint rank = gl_WorkGroupID.x * uint(RELIEF_RADIX_DIGITS) + gl_LocalInvocationIndex;
    ivec4 tiles = ivec4(0, 0, -1, -1);
    if (rank < u_count) {
        vec4 place = uintBitsToFloat(b_sprites[2u * rank]);
        if (place.z > 0.0) {
            tiles = tilesOf(place.xy, place.z);
        }
    }
    uint at = b_counts[gl_WorkGroupID.x] + sumBefore(tileCount(tiles));
    if (b_work[0] == 0u) {
        return;
    }
    for (int y = tiles.y; y <= tiles.w; ++y) {
        for (int x = tiles.x; x <= tiles.z; ++x) {
            b_entries[at++] = uvec2(rank, uint(y * u_tiles.x + x));
        }
    }
}
