// SPDX-License-Identifier: Apache-2.0
// Updates the keys of an order for the current positions of particles and viewer, without reordering.
//
//     order texture, uint    x   index of the particle to draw at this rank
//                            y   sortKey(); 0 for dead and missing particles
//!include picture/sort_key.glsl

uniform highp usampler2D u_order;
uniform int u_kept;    // lower ranks have an order; rank i from here on gets index i
uniform int u_extent;  // indices from here on are missing

layout(location = 0) out uvec2 o_element;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int rank = texel.y * RELIEF_ORDER_WIDTH + texel.x;
    int index = rank < u_kept ? int(texelFetch(u_order, texel, 0).x) : rank;
    o_element = uvec2(uint(index), index < u_extent ? sortKey(index) : 0u);
}
