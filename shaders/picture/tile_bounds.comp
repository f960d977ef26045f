// SPDX-License-Identifier: Apache-2.0
// Finds the range of entries of each tile. A work group paints the entries of its tile one by one. If a whole cloud
// lies in a few tiles, painting takes longer than drawing points; the sprites are then drawn instead.
layout(local_size_x = RELIEF_RADIX_DIGITS) in;
//!include picture/tile.glsl
layout(std430, binding = 0) readonly buffer Entries { uvec2 b_entries[]; };
layout(std430, binding = 2) writeonly buffer Bounds { uvec2 b_bounds[]; };
layout(std430, binding = 3) buffer Work { uint b_work[RELIEF_TILE_WORDS]; };

// Returns the number of entries of higher tiles, which come first.
uint entriesAbove(int tile) {
    uint low = 0u;
    uint high = b_work[0];
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (int(b_entries[middle].y) > tile) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

void main() {
    int tile = int(gl_GlobalInvocationID.x);
    if (tile >= u_tiles.x * u_tiles.y) {
        return;
    }
    uvec2 bounds = uvec2(entriesAbove(tile), entriesAbove(tile - 1));
    b_bounds[tile] = bounds;
    if (bounds.y - bounds.x > uint(RELIEF_TILE_ENTRIES_MAX)) {
        b_work[1] = b_work[5];
        b_work[6] = 1u;
    }
}
