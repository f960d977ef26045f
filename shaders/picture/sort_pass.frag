// SPDX-License-Identifier: Apache-2.0
// One pass of Batcher's odd-even merge sort. Blocks of u_block ranks with sorted halves are merged by passes with
// strides u_block/2, u_block/4, … 1. In a block of 8 ranks, these pairs are compared:
//
//     stride 4    o---------------o          stride 2       o-------o          stride 1   o---o
//                     o---------------o                         o-------o                         o---o
//                         o---------------o                                                               o---o
//                             o---------------o
//     rank        0   1   2   3   4   5   6   7             2   3   4   5                 1   2   3   4   5   6
//
// Every pair is left in order, with the element to draw first at the lower rank. No pair is ever reversed (as in a
// bitonic sort), so no pass makes an order worse (depth_sort.h).
uniform highp usampler2D u_order;
uniform uint u_block;   // powers of two
uniform uint u_stride;

layout(location = 0) out uvec2 o_element;

uvec2 elementAt(uint rank) {
    return texelFetch(u_order, ivec2(rank % uint(RELIEF_ORDER_WIDTH), rank / uint(RELIEF_ORDER_WIDTH)), 0).xy;
}

// Orders by distance, farthest first; ties by index. A total order, because indices are unique.
bool before(uvec2 a, uvec2 b) {
    return a.y > b.y || (a.y == b.y && a.x < b.x);
}

void main() {
    uvec2 texel = uvec2(gl_FragCoord.xy);
    uint rank = texel.y * uint(RELIEF_ORDER_WIDTH) + texel.x;
    uint place = rank & (u_block - 1u);  // in its block
    bool first = 2u * u_stride == u_block;
    bool lower = ((place & u_stride) == 0u) == first;
    // Negative values wrap around to far beyond the block.
    uint partner = lower ? place + u_stride : place - u_stride;

    uvec2 mine = elementAt(rank);
    o_element = mine;
    if (partner < u_block) {
        uvec2 other = elementAt(rank - place + partner);
        if (lower ? before(other, mine) : before(mine, other)) {
            o_element = other;
        }
    }
}
