// The material of a contact: formats/materials.cpp is the same in C++. The data lie in one texture, as
// runtime/collider/material_table.h writes them, texel i at (i mod width, i / width):
//
//     from 0         bodies: the first texel of the record of each one's collider; 0: it has no materials
//     a record       lowest corner of the cube, object space, and 1 / its side; then materials, and the texel of the root, 0 without
//                    a tree (RELIEF_MATERIAL_HEAD_TEXELS); then each material: restitution, 1 - friction and loss of lifetime as
//                    floats, number of the name; then each pair of sides: axis, towards, against; then the nodes of
//                    formats/materials.h, three words each
uniform highp usampler2D u_relief_materials;

uvec4 reliefMaterialTexel(int i) {
    return texelFetch(u_relief_materials, reliefTexel(i, RELIEF_MATERIALS_LOG2_WIDTH), 0);
}

// How many of the low `count` bits of a byte are set, up to 7.
int reliefBitsBelow(uint bits, int count) {
    uint some = bits & ((1u << uint(count)) - 1u);
    some -= (some >> 1u) & 0x55u;
    some = (some & 0x33u) + ((some >> 2u) & 0x33u);
    return int((some + (some >> 4u)) & 15u);
}

// The leaf of a tree at q, of the cube's [0, 1]^3.
int reliefMaterialLeaf(int root, vec3 q) {
    int node = root;
    int leaf = -1;
    for (int level = 0; level < RELIEF_MATERIAL_LEVELS && leaf < 0; ++level) {
        q *= 2.0;
        ivec3 upper = ivec3(greaterThanEqual(q, vec3(1.0)));
        q -= vec3(upper);
        int octant = upper.x + 2 * upper.y + 4 * upper.z;
        uvec4 words = reliefMaterialTexel(node);
        if ((words.x >> uint(octant) & 1u) == 0u) {
            leaf = int((octant < 4 ? words.y : words.z) >> uint(8 * (octant & 3)) & 255u);
        } else {
            node = root + int(words.x >> 8u) + reliefBitsBelow(words.x, octant);
        }
    }
    return max(leaf, 0);
}

// 0 to 8: x, y, z, x + y, x - y, x + z, x - z, y + z, y - z.
float reliefAlongMaterialAxis(vec3 v, int axis) {
    float first = axis == 0 || (axis > 2 && axis < 7) ? v.x : axis == 2 ? v.z : v.y;
    float second = axis < 5 ? v.y : v.z;
    return axis < 3 ? first : first + (axis % 2 == 1 ? second : -second);
}

// Of a body's surface near p, with the normal n, of any length; both in the body's object space: restitution, 1 - friction,
// seconds of life that a step in contact costs, and the number of the name + 1. Without a material 1, 1, 0, 0.
vec4 reliefMaterial(int body, vec3 p, vec3 n) {
    int record = int(reliefMaterialTexel(body).x);
    if (record == 0) {
        return vec4(1.0, 1.0, 0.0, 0.0);
    }
    vec4 cube = uintBitsToFloat(reliefMaterialTexel(record));
    ivec2 sizes = ivec2(reliefMaterialTexel(record + 1).xy);
    int first = record + RELIEF_MATERIAL_HEAD_TEXELS;
    int leaf = 0;
    if (sizes.y > 0) {
        leaf = reliefMaterialLeaf(sizes.y, clamp((p - cube.xyz) * cube.w, 0.0, 1.0));
    }
    if (leaf >= sizes.x) {
        ivec3 pair = ivec3(reliefMaterialTexel(first + leaf).xyz);
        leaf = reliefAlongMaterialAxis(n, pair.x) >= 0.0 ? pair.y : pair.z;
    }
    uvec4 words = reliefMaterialTexel(first + leaf);
    return vec4(uintBitsToFloat(words.xyz), float(words.w) + 1.0);
}
