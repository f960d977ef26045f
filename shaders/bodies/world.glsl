// SPDX-License-Identifier: Apache-2.0
// The data of a world, written by body_table.h. Everything is in one texture of words, because uniform blocks are
// too small for many bodies and OpenGL ES 3.0 has no other buffers. Texel i is at (i mod width, i / width).
//
//     from texel 0             ReliefMap of each map, in RELIEF_WORLD_MAP_TEXELS texels. With RELIEF_PLACED each body
//                              has one map of patches in world space: map i belongs to body i
//     u_relief_world_place.y   bodies, in RELIEF_WORLD_BODY_TEXELS texels each: index of the first map, number of maps,
//                              1 if live, the bit of its group in ParticleType::collides_with; scale (world units per object
//                              unit), restitution, 1 - friction, 1 if it moves in the step; world to object space at
//                              the end of the step (a rotation divided by the scale), three rows; the transform of a
//                              point of the body from the start of the step to its end, in world space, three rows
//     see u_relief_levels      lists of the broad phase (body_grid.h): index of the second entry; index after the last;
//                              body (negative: none) and hash of the first entry
//     see the lists            entries: body and hash; 0; 0
layout(std140) uniform ReliefMaps {
    ivec4 u_relief_count;        // maps in use; then RELIEF_LOG2_WIDTHS
    ivec4 u_relief_world_place;  // log2 of the width; the first texel of body 0; bodies; levels
    ivec4 u_relief_levels[RELIEF_WORLD_LEVELS];  // cells per world unit, as a float's bits; texel of the first list;
                                                 // mask of the hash; 0
};

uniform highp usampler2D u_relief_world;

uvec4 reliefWords(int i) {
    return texelFetch(u_relief_world, reliefTexel(i, u_relief_world_place.x), 0);
}

vec4 reliefMapFloats(int i, int k) {
    return uintBitsToFloat(reliefWords(RELIEF_WORLD_MAP_TEXELS * i + k));
}
vec4 reliefMapRow(int i, int k) {
    return reliefMapFloats(i, k);
}
vec4 reliefMapColumn(int i, int k) {
    return reliefMapFloats(i, 3 + k);
}
vec4 reliefObjectPerMap(int i) {
    return reliefMapFloats(i, 6);
}
ivec4 reliefMapPlace(int i) {
    return ivec4(reliefWords(RELIEF_WORLD_MAP_TEXELS * i + 7));
}
ivec4 reliefMapInfo(int i) {
    return ivec4(reliefWords(RELIEF_WORLD_MAP_TEXELS * i + 8));
}

vec4 reliefBodyFloats(int body, int k) {
    return uintBitsToFloat(reliefWords(u_relief_world_place.y + RELIEF_WORLD_BODY_TEXELS * body + k));
}
ivec4 reliefBodyMaps(int body) {
    return ivec4(reliefWords(u_relief_world_place.y + RELIEF_WORLD_BODY_TEXELS * body));
}
vec4 reliefBodyResponse(int body) {
    return reliefBodyFloats(body, 1);
}
vec4 reliefBodyRow(int body, int k) {
    return reliefBodyFloats(body, 2 + k);
}
vec4 reliefBodyMove(int body, int k) {
    return reliefBodyFloats(body, 5 + k);
}
int reliefBodyCount() {
    return u_relief_world_place.z;
}
