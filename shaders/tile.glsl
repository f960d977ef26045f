// Points painted tile by tile (runtime/picture/tile_painter.h): the picture is cut into tiles, each tile gets a list of the
// sprites that reach it, in the order in which they are drawn, and a work group paints it from the last sprite to the first.
//
//     b_sprites, of rank i     2 i: place in pixels, diameter in pixels (0: nothing to draw), window depth
//                          2 i + 1: the grain's three words
//     entries                   x: rank, y: tile; sorted by tile, of one tile in the order of ranks (radix.glsl)
//     b_work                    0: entries, if there was room for all; else 0. Then the four words of an indirect draw
//                               of points: all of them if there was no room, else none
uniform ivec2 u_tiles;    // columns, rows
uniform ivec2 u_picture;  // pixels

// The tiles that hold pixels of a sprite: the first's and the last's column and row. The last is before the first if there
// are none.
ivec4 tilesOf(vec2 at, float pixels) {
    // The pixels whose centres it covers, as a point's.
    ivec2 first = max(ivec2(ceil(at - 0.5 * pixels - 0.5)), ivec2(0));
    ivec2 last = min(ivec2(floor(at + 0.5 * pixels - 0.5)), u_picture - 1);
    return any(lessThan(last, first)) ? ivec4(0, 0, -1, -1) : ivec4(first, last) / RELIEF_TILE_SIDE;
}

uint tileCount(ivec4 tiles) {
    return uint((tiles.z - tiles.x + 1) * (tiles.w - tiles.y + 1));
}
