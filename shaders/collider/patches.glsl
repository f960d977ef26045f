// SPDX-License-Identifier: Apache-2.0
// The vote of a map of patches. formats/patch_tree.h documents the texels; formats/patch_tree.cpp is the C++ version.

// Returns the two halves of a texel.
uvec2 reliefPatchTexel(int index) {
    uvec4 words = texelFetch(u_relief_front_back, reliefTexel(index, RELIEF_LOG2_WIDTHS.z), 0);
    return uvec2(words.r | (words.g << 16), words.b | (words.a << 16));
}

// Counts the bits set in a byte; OpenGL ES 3.0 has no bitCount().
int reliefBitCount(uint bits) {
    bits -= (bits >> 1) & 0x55u;
    bits = (bits & 0x33u) + ((bits >> 2) & 0x33u);
    return int((bits + (bits >> 4)) & 0xfu);
}

// Transforms q into the frame of a patch: u, v and the depth w.
vec3 reliefPatchAcross(uvec2 record, vec3 q) {
    uint diagonal = (record.x >> 5) & 3u;
    uint axis = (record.x >> 7) & 3u;
    vec3 abc = axis == 0u ? q : axis == 1u ? q.yzx : q.zxy;
    vec2 mirrored = vec2(float((record.x >> 9) & 1u), float((record.x >> 10) & 1u));
    abc.xy = mirrored + (1.0 - 2.0 * mirrored) * abc.xy;
    vec3 at = vec3(abc.y, abc.z, abc.x);
    if (diagonal != 0u) {
        at.x = 0.5 * (abc.x - abc.y + 1.0);
        at.y = diagonal == 1u ? abc.z : 0.25 * (abc.x + abc.y - 2.0 * abc.z + 2.0);
        at.z = diagonal == 1u ? abc.x + abc.y : abc.x + abc.y + abc.z;
    }
    return at;
}

// Returns the number of grid squares along a side.
float reliefPatchSquares(uvec2 record) {
    uint size = (record.x >> 2) & 3u;
    return size == 0u ? 1.0 : size == 1u ? 2.0 : 4.0;
}

// Returns the codes at the corners 00, 10, 01 and 11 of a grid square with the lowest corner `corner`.
vec4 reliefPatchCodes(int first, uvec2 record, vec2 corner, float squares) {
    int side = int(squares) + 1;
    int at = int(corner.y) * side + int(corner.x);
    int end = side * side - 1;
    // The four codes lie within seven bytes, so in two consecutive texels. For 2 by 2 heights, all but the last are in
    // the record.
    ivec4 i = ivec4(at, at + 1, at + side, at + side + 1);
    uvec4 words = uvec4(record.y, 0u, 0u, 0u);
    if (side > 2) {
        int texel = first + int(record.y & 0xffffffu);
        int begin = at >> 3;
        words = uvec4(reliefPatchTexel(texel + begin), reliefPatchTexel(texel + min(begin + 1, (end - 1) >> 3)));
        i -= 8 * begin;
        end -= 8 * begin;
    }
    uvec4 low = uvec4((i.x & 4) != 0 ? words.y : words.x, (i.y & 4) != 0 ? words.y : words.x,
                      (i.z & 4) != 0 ? words.y : words.x, (i.w & 4) != 0 ? words.y : words.x);
    uvec4 high = uvec4((i.x & 4) != 0 ? words.w : words.z, (i.y & 4) != 0 ? words.w : words.z,
                       (i.z & 4) != 0 ? words.w : words.z, (i.w & 4) != 0 ? words.w : words.z);
    uvec4 four = uvec4(i.x > 7 ? high.x : low.x, i.y > 7 ? high.y : low.y, i.z > 7 ? high.z : low.z,
                       i.w > 7 ? high.w : low.w);
    uvec4 codes = (four >> uvec4(8 * (i & 3))) & 0xffu;
    codes.w = i.w == end ? (record.x >> 23) & 0xffu : codes.w;
    return vec4(codes);
}

// Return the height of code 0, and the height of one code step.
float reliefPatchBase(uvec2 record) {
    return (float((record.x >> 11) & 0xfffu) - 2048.0) * (1.0 / 512.0);
}
float reliefPatchStep(uvec2 record) {
    uint scale = record.y >> 24;
    // Builds 2^((scale >> 4) - 12) from its bits, because exp2() may round.
    float range = (1.0 + float(scale & 15u) * (1.0 / 16.0)) * uintBitsToFloat(((scale >> 4) + 115u) << 23);
    return range * (1.0 / 255.0);
}

// Returns xyz: the gradient in the cell, unit length and outwards; w: the distance, in cells.
vec4 reliefPatch(int first, uvec2 record, vec3 q) {
    uint diagonal = (record.x >> 5) & 3u;
    uint axis = (record.x >> 7) & 3u;
    vec2 way = 1.0 - 2.0 * vec2(float((record.x >> 9) & 1u), float((record.x >> 10) & 1u));
    vec3 at = reliefPatchAcross(record, q);
    float last = reliefPatchSquares(record);
    vec2 place = at.xy * last;
    vec2 corner = clamp(floor(place), 0.0, last - 1.0);
    vec2 t = place - corner;
    vec4 c = reliefPatchCodes(first, record, corner, last);
    float unit = reliefPatchStep(record);
    float lower = c.x + t.x * (c.y - c.x);
    float upper = c.z + t.x * (c.w - c.z);
    float height = reliefPatchBase(record) + unit * (lower + t.y * (upper - lower));
    vec2 by = (unit * last) * vec2((c.y - c.x) + t.y * ((c.w - c.z) - (c.y - c.x)), upper - lower);
    vec3 gradient = vec3(1.0, -by.x, -by.y);
    if (diagonal != 0u) {
        float v = diagonal == 1u ? 0.0 : 0.25 * by.y;
        gradient = vec3(1.0 - 0.5 * by.x - v, 1.0 + 0.5 * by.x - v, diagonal == 1u ? -by.y : 1.0 + 0.5 * by.y);
    }
    gradient.xy *= way;
    gradient = axis == 0u ? gradient : axis == 1u ? gradient.zxy : gradient.yzx;
    float per_length = inversesqrt(reliefDot(gradient, gradient));
    per_length = (record.x & 16u) != 0u ? -per_length : per_length;
    return vec4(per_length * gradient, (at.z - height) * per_length);
}

// As reliefPatch(), but also for pairs.
vec4 reliefPatchOrPair(int first, uvec2 record, vec3 q) {
    bool pair = (record.x & 15u) == 15u;
    int at = first + int(record.y & 0xffffffu);
    vec4 piece = reliefPatch(first, pair ? reliefPatchTexel(at) : record, q);
    if (pair) {
        vec4 other = reliefPatch(first, reliefPatchTexel(at + 1), q);
        bool both = (record.x & 16u) != 0u;
        piece = (both ? other.w > piece.w : other.w < piece.w) ? other : piece;
    }
    return piece;
}

// The leaf of a tree that contains a point.
struct ReliefLeaf {
    uvec2 record;  // its own record, or that of its split parent if it has none
    vec3 q;        // the point in the unit cube of the record's cell
    float cell;    // size of that cell, in roots
    bool inside;   // for leaves without a patch
    bool beside;   // the leaf has no record
};

// p: map space, within the roots.
ReliefLeaf reliefPatchLeaf(ivec4 place, vec3 p) {
    vec3 root = floor(p);
    vec3 q = p - root;
    ivec3 at = ivec3(root);
    uvec2 record = reliefPatchTexel(place.x + 1 + at.z * place.z + at.y * place.y + at.x);
    float cell = 1.0;
    bool inside = (record.x & 3u) == 1u;
    bool beside = false;
    for (int level = 0; level < place.w && (record.x & 3u) == 2u && !beside; ++level) {
        vec3 child = 2.0 * q;
        vec3 upper = step(vec3(1.0), child);
        int octant = int(upper.x) + 2 * int(upper.y) + 4 * int(upper.z);
        uint children = (record.x >> 2) & 0xffu;
        beside = ((children >> octant) & 1u) == 0u;
        if (beside) {
            inside = ((record.x >> (10 + octant)) & 1u) != 0u;
        } else {
            q = child - upper;
            cell *= 0.5;
            int before = reliefBitCount(children & ((1u << octant) - 1u));
            record = reliefPatchTexel(place.x + int(record.y & 0xffffffu) + before);
            inside = (record.x & 3u) == 1u;
        }
    }
    return ReliefLeaf(record, q, cell, inside, beside);
}

// Returns the number of roots along x, y and z.
vec3 reliefPatchRoots(int i) {
    return reliefObjectPerMap(i).yzw;
}

// Returns a distance on the side of a cell without a patch.
float reliefOnSide(bool inside, float distance, float nearest) {
    return inside ? min(distance, -nearest) : max(distance, nearest);
}

// p: map space. Without `whole`, any distance >= 0 means outside.
ReliefVote reliefVotePatches(int i, ivec4 info, vec3 p, bool whole) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    ReliefVote vote = ReliefVote(encloses ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
    if (all(greaterThanEqual(p, vec3(0.0))) && all(lessThan(p, reliefPatchRoots(i)))) {
        ivec4 place = reliefMapPlace(i);
        ReliefLeaf leaf = reliefPatchLeaf(place, p);
        uvec2 record = leaf.record;
        float cell = leaf.cell;
        vec3 normal = vec3(0.0);
        float distance = RELIEF_FAR_OUTSIDE;
        if ((record.x & 3u) == 3u) {
            vec4 piece = reliefPatchOrPair(place.x, record, leaf.q);
            normal = piece.xyz;
            distance = cell * piece.w;
        } else if (leaf.inside || whole) {
            bool coarse = (record.x & 3u) == 2u;
            normal = reliefUnit(coarse ? reliefFold(vec2(float((record.x >> 18) & 127u), float(record.x >> 25)), 63.0)
                                       : reliefOctahedron(record.x >> 16));
            float along = reliefDot(normal, leaf.q - 0.5);
            float offset = (float(record.y >> 24) - 128.0) * (1.0 / 128.0);
            float nearest = cell * (1.0 / 1024.0);
            distance = coarse ? cell * (along + offset) : uintBitsToFloat(record.y) + cell * along;
            distance = reliefOnSide(leaf.inside, distance, nearest);
        }
        float root_size = reliefObjectPerMap(i).x;
        bool known = distance < RELIEF_FAR_OUTSIDE;
        vote.distance = known ? distance * root_size : RELIEF_FAR_OUTSIDE;
        if (known && (whole || distance < 0.0)) {
            vote.normal = reliefFromMap(i, normal) * (1.0 / root_size);
        }
    }
    return vote;
}
