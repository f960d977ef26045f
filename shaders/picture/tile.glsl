// SPDX-License-Identifier: Apache-2.0
// Points painted tile by tile (runtime/picture/tile_painter.h): the picture is cut into tiles, each tile gets a list of the
// sprites that reach it, in the order in which they are drawn, and a work group paints it from the last sprite to the first.
//
//     b_sprites, of rank i     3 i: place of the middle in pixels, diameter in pixels, window depth
//                          3 i + 1: the sprite's three words; cell of the atlas
//                          3 i + 2: first and last tile that it reaches, cosine and sine of its rotation, and how much longer
//                                   than wide it is, in pixels
//     entries                   x: rank, y: tile; sorted by tile, of one tile in the order of ranks (radix.glsl)
//     b_work                    0: entries, if there was room for all; else 0. 1–4: an indirect draw of the sprites: of
//                               all if they are not painted, else of none. 5: vertices of all; 6: some tile has too many
//     b_bounds                  the first entry of each tile, and the one behind its last
//
// Points are upright squares; with RELIEF_QUADS they turn, as in point.vert. Soft discs are the same in both.
uniform ivec2 u_tiles;    // columns, rows
uniform ivec2 u_picture;  // pixels

const uvec2 NO_TILES = uvec2(1u, 0u);  // the last column is before the first

// The tiles that hold pixels whose centres are not farther than `reach` from a place: column and row of the first and of the
// last, 16 bits each.
uvec2 tilesOf(vec2 at, vec2 reach) {
    // Conversions of numbers that do not fit would be undefined.
    vec2 most = vec2(u_picture);
    ivec2 first = ivec2(clamp(ceil(at - reach - 0.5), vec2(0.0), most));
    ivec2 last = ivec2(clamp(floor(at + reach - 0.5), vec2(-1.0), most - 1.0));
    if (any(lessThan(last, first))) {
        return NO_TILES;
    }
    uvec2 low = uvec2(first) / uint(RELIEF_TILE_SIDE);
    uvec2 high = uvec2(last) / uint(RELIEF_TILE_SIDE);
    return uvec2(low.x | low.y << 16, high.x | high.y << 16);
}

// Column and row of the first tile and of the last.
uvec4 unpackTiles(uvec2 tiles) {
    return uvec4(tiles.x & 0xffffu, tiles.x >> 16, tiles.y & 0xffffu, tiles.y >> 16);
}

uint tileCount(uvec2 tiles) {
    uvec4 t = unpackTiles(tiles);
    return (t.z + 1u - t.x) * (t.w + 1u - t.y);
}
