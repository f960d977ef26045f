// SPDX-License-Identifier: Apache-2.0
// Tile-based painting of points (runtime/picture/tile_painter.h). The picture is divided into tiles. Each tile gets a
// list of the sprites that touch it, in drawing order, and a work group paints it from the last sprite to the first.
//
//     b_sprites, rank i        3 i: position of the centre in pixels, diameter in pixels, window depth
//                          3 i + 1: the sprite's three words; atlas cell
//                          3 i + 2: first and last tile that it touches, cosine and sine of its rotation, and its extra
//                                   length over its width, in pixels
//     entries                   x: rank, y: tile; sorted by tile, within a tile by rank (radix.glsl)
//     b_work                    0: number of entries, 0 if there was no room. 1–4: an indirect draw of the sprites: all
//                               if they are not painted, else none. 5: vertices of all; 6: 1 if a tile has too many
//     b_bounds                  first entry of each tile, and one past its last
//
// Points are upright squares; with RELIEF_QUADS they rotate, as in point.vert. Soft discs are the same in both.
uniform ivec2 u_tiles;    // columns, rows
uniform ivec2 u_picture;  // pixels

const uvec2 NO_TILES = uvec2(1u, 0u);  // the last column is before the first

// Returns the tiles with pixel centres within `reach` of a position: column and row of the first and of the last, 16
// bits each.
uvec2 tilesOf(vec2 at, vec2 reach) {
    // Clamp first: conversions of values out of range are undefined.
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

// Returns column and row of the first and of the last tile.
uvec4 unpackTiles(uvec2 tiles) {
    return uvec4(tiles.x & 0xffffu, tiles.x >> 16, tiles.y & 0xffffu, tiles.y >> 16);
}

uint tileCount(uvec2 tiles) {
    uvec4 t = unpackTiles(tiles);
    return (t.z + 1u - t.x) * (t.w + 1u - t.y);
}
