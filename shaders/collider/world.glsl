// The data of a world, as body_table.h writes it: all in one texture of words, texel i at (i mod width, i / width), since a
// block of uniforms is too small for more than a few bodies, and OpenGL ES 3.0 has no other buffers.
//
//     from texel 0                   ReliefMap of each map, in RELIEF_WORLD_MAP_TEXELS texels
//     u_relief_world_place.y         bodies, in RELIEF_WORLD_BODY_TEXELS texels: world to object space at the end of the step (a
//                                    rotation, divided by scale) and at its beginning, three rows each; scale (world units of
//                                    an object unit), restitution, 1 - friction, 0; the first map, how many, 1 if they are
//                                    live, the bit of its group in ParticleType::collides
//     as u_relief_levels have it     lists of the broad phase (body_grid.h): their first and last but one entry; 0; 0
//     as the lists have it           entries: body, box and cell of BodyGrid::Entry
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
vec4 reliefBodyRow(int body, int k) {
    return reliefBodyFloats(body, k);
}
vec4 reliefBodyRowBefore(int body, int k) {
    return reliefBodyFloats(body, 3 + k);
}
vec4 reliefBodyResponse(int body) {
    return reliefBodyFloats(body, 6);
}
ivec4 reliefBodyMaps(int body) {
    return ivec4(reliefWords(u_relief_world_place.y + RELIEF_WORLD_BODY_TEXELS * body + 7));
}
int reliefBodyCount() {
    return u_relief_world_place.z;
}
