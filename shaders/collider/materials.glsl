// The material of a contact: formats/materials.cpp is the same in C++. The data are words in one texture, as
// runtime/collider/material_table.h writes them, word i at (i mod width, i / width):
//
//     from 0         bodies: the first word of the record of each one's collider; 0: it has no materials
//     a record       lowest corner of the cube, object space; 1 / its side; materials; first word of the root, 0 without a tree
//                    (RELIEF_MATERIAL_HEAD_WORDS); then each material (RELIEF_MATERIAL_WORDS): restitution, 1 - friction and loss
//                    of lifetime as floats, number of the name; then each pair of sides, axis + 256 * towards + 65536 * against;
//                    then the nodes (RELIEF_MATERIAL_NODE_WORDS) of formats/materials.h
uniform highp usampler2D u_relief_materials;

uint reliefMaterialWord(int i) {
    return texelFetch(u_relief_materials, reliefTexel(i, RELIEF_MATERIALS_LOG2_WIDTH), 0).x;
}

float reliefMaterialFloat(int i) {
    return uintBitsToFloat(reliefMaterialWord(i));
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
        uint head = reliefMaterialWord(node);
        if ((head >> uint(octant) & 1u) == 0u) {
            leaf = int(reliefMaterialWord(node + 1 + octant / 4) >> uint(8 * (octant % 4)) & 255u);
        } else {
            node = root + RELIEF_MATERIAL_NODE_WORDS * (int(head >> 8u) + reliefBitsBelow(head, octant));
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
    vec4 material = vec4(1.0, 1.0, 0.0, 0.0);
    int record = int(reliefMaterialWord(body));
    if (record > 0) {
        vec3 corner = vec3(reliefMaterialFloat(record), reliefMaterialFloat(record + 1), reliefMaterialFloat(record + 2));
        int count = int(reliefMaterialWord(record + 4));
        int root = int(reliefMaterialWord(record + 5));
        int first = record + RELIEF_MATERIAL_HEAD_WORDS;
        int leaf = 0;
        if (root > 0) {
            leaf = reliefMaterialLeaf(root, clamp((p - corner) * reliefMaterialFloat(record + 3), 0.0, 1.0));
        }
        if (leaf >= count) {
            uint pair = reliefMaterialWord(first + RELIEF_MATERIAL_WORDS * count + leaf - count);
            leaf = int(pair >> (reliefAlongMaterialAxis(n, int(pair & 255u)) >= 0.0 ? 8u : 16u) & 255u);
        }
        int at = first + RELIEF_MATERIAL_WORDS * leaf;
        material = vec4(reliefMaterialFloat(at), reliefMaterialFloat(at + 1), reliefMaterialFloat(at + 2),
                        float(reliefMaterialWord(at + 3)) + 1.0);
    }
    return material;
}
