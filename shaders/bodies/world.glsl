// SPDX-License-Identifier: Apache-2.0
// The data of a world, as body_table.h writes it: all in one texture of words, texel i at (i mod width, i / width), since a
// block of uniforms is too small for more than a few bodies, and OpenGL ES 3.0 has no other buffers.
//
//     from texel 0                   ReliefMap of each map, in RELIEF_WORLD_MAP_TEXELS texels. With RELIEF_PLACED each body has one
//                                    of patches, placed: map i is of body i, and its object space is the world
//     u_relief_world_place.y         bodies, in RELIEF_WORLD_BODY_TEXELS texels: the first map, how many, 1 if they are live, the
//                                    bit of its group in ParticleType::collides; scale (world units of an object unit),
//                                    restitution, 1 - friction, 1 if it moves in the step; world to object space at the end
//                                    of the step (a rotation, divided by scale), three rows; what takes a point of the body in
//                                    the world from the beginning of the step to its end, three rows
//     as u_relief_levels have it     lists of the broad phase (body_grid.h): the second entry; the one after the last; the
//                                    body, below 0 if there is none, and the hash of the first entry
//     as the lists have it           entries: body and hash; 0; 0
layout(std140) uniform ReliefCollider {
    ivec4 u_relief_count;        // maps in use; then RELIEF_LOG2_WIDTHS
    ivec4 u_relief_world_place;  // log2 of the width; the first texel of body 0; bodies; levels
    ivec4 u_relief_levels[RELIEF_WORLD_LEVELS];  // cells in a world unit, as a float's bits; texel of the first list; mask of the hash; 0
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
