// SPDX-License-Identifier: Apache-2.0
// Refreshes the keys of an order for the present places of particles and viewer; the order itself stays.
//
//     order texture, uint    x   index of the particle that is drawn rank-th
//                            y   sortKey(); 0 for the dead and the absent
//!include picture/sort_key.glsl

uniform highp usampler2D u_order;
uniform int u_kept;    // ranks below it hold an order; from it on rank i gets index i
uniform int u_extent;  // indices from it on are absent

layout(location = 0) out uvec2 o_element;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int rank = texel.y * RELIEF_ORDER_WIDTH + texel.x;
    int index = rank < u_kept ? int(texelFetch(u_order, texel, 0).x) : rank;
    o_element = uvec2(uint(index), index < u_extent ? sortKey(index) : 0u);
}
