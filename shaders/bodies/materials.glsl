// SPDX-License-Identifier: Apache-2.0
// Returns the material of a contact; formats/materials.cpp is the C++ version. The octree of a collider is converted
// into a top grid and, where it is deeper, bricks of 4^3 entries for two levels each, which needs fewer dependent
// fetches. The data are in one texture, written by runtime/bodies/material_table.h. Texel i is at
// (i mod width, i / width):
//
//     bodies       RELIEF_MATERIAL_HEAD_TEXELS per body: lowest corner of the cube, object space, and 1 / side; then
//                  the texels of the first material (0: none) and of the top grid, log2 of the cells along the cube and
//                  along the top grid
//     a collider   each material: restitution, 1 - friction and lifetime loss as floats, number of the name; then the
//                  top grid, x fastest, four entries per texel; then bricks
//     an entry     RELIEF_MATERIAL_IS_BRICK plus its first texel; or a material; or, in bytes from the lowest, the
//                  materials of surfaces that face against an axis and along it, and 1 + the axis
uniform highp usampler2D u_relief_materials;
// Texel indices of a single collider in its own space.
#if RELIEF_BODIES == 0
uniform vec4 u_relief_material_cube;
uniform ivec4 u_relief_material_grids;
#endif

uvec4 reliefMaterialTexel(int i) {
    return texelFetch(u_relief_materials, reliefTexel(i, RELIEF_MATERIALS_LOG2_WIDTH), 0);
}

// Returns an entry of a grid with 2^log2 cells along each axis.
uint reliefMaterialEntry(int grid, ivec3 at, int log2) {
    int i = at.x + (at.y << log2) + (at.z << 2 * log2);
    uvec4 four = reliefMaterialTexel(grid + (i >> 2));
    uvec2 two = (i & 2) == 0 ? four.xy : four.zw;
    return (i & 1) == 0 ? two.x : two.y;
}

// axis: 0 to 8 for x, y, z, x + y, x - y, x + z, x - z, y + z, y - z.
float reliefAlongMaterialAxis(vec3 v, int axis) {
    float first = axis == 0 || (axis > 2 && axis < 7) ? v.x : axis == 2 ? v.z : v.y;
    float second = axis < 5 ? v.y : v.z;
    return axis < 3 ? first : first + (axis % 2 == 1 ? second : -second);
}

// Returns the material of a body's surface near p with the normal n, of any length, both in object space: restitution,
// 1 - friction, seconds of life that a step in contact costs, and the number of the name + 1. Returns 1, 1, 0, 0
// without a material.
vec4 reliefMaterial(int body, vec3 p, vec3 n) {
#if RELIEF_BODIES == 0
    vec4 cube = u_relief_material_cube;
    ivec4 grids = u_relief_material_grids;
#else
    vec4 cube = uintBitsToFloat(reliefMaterialTexel(RELIEF_MATERIAL_HEAD_TEXELS * body));
    ivec4 grids = ivec4(reliefMaterialTexel(RELIEF_MATERIAL_HEAD_TEXELS * body + 1));
#endif
#if RELIEF_BODIES > 0
    if (grids.x == 0) {
        return vec4(1.0, 1.0, 0.0, 0.0);
    }
#endif
    float cells = float(1 << grids.z);
    ivec3 cell = ivec3(min(clamp((p - cube.xyz) * cube.w, 0.0, 1.0) * cells, cells - 1.0));
    int below = grids.z - grids.w;  // log2 of the cells along an entry
    uint entry = reliefMaterialEntry(grids.y, cell >> below, grids.w);
    // No early exit: a loop that ends early is not unrolled, which made the whole step a fifth slower on an H100.
    for (int i = 0; i < RELIEF_MATERIAL_BRICKS; ++i) {
        if ((entry & uint(RELIEF_MATERIAL_IS_BRICK)) != 0u) {
            below -= 2;
            entry = reliefMaterialEntry(int(entry) - RELIEF_MATERIAL_IS_BRICK, (cell >> below) & 3, 2);
        }
    }
    if (entry > 255u) {
        bool along = reliefAlongMaterialAxis(n, int(entry >> 16u) - 1) >= 0.0;
        entry = along ? entry >> 8u & 255u : entry & 255u;
    }
    uvec4 words = reliefMaterialTexel(grids.x + int(entry));
    return vec4(uintBitsToFloat(words.xyz), float(words.w) + 1.0);
}
