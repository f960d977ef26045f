// SPDX-License-Identifier: Apache-2.0
// Generated from relief.glsl by translate.py.
// Collides particles with a Relief collider in any shader:
//     ReliefSurface s = reliefDistance(texels, collider, p);                     // nearest surface of a point
//     ReliefMotion m = reliefCollide(texels, collider, p, v, radius, 0.4, 0.2);  // a particle after the contact
// texels: RGBA16UI without filtering, 2048 texels wide. collider: 80 bytes, laid out as std140. relief.h returns both.
// Lengths are in object units. formats/README.md specifies the arithmetic, formats/patch_tree.cpp is the C++ version.
#pragma once
#ifndef RELIEF_LOG2_WIDTH
#define RELIEF_LOG2_WIDTH 11u
#endif
#ifndef RELIEF_PRECISE  // define it as `precise`, if the compiler supports it, to get exactly the signs of the CPU
#define RELIEF_PRECISE
#endif
struct ReliefCollider {
    float4 row_x;  // object space to map space, whose unit is a root cell
    float4 row_y;
    float4 row_z;
    float4 size;   // edge of a root cell; number of root cells along x, y and z
    int4 place;    // index of the first texel; stride of roots along y and z, texels; levels below the roots
};
struct ReliefSurface {
    float3 normal;   // outwards, of unit length; zero outside the root cells
    float distance;  // positive outside, negative inside; 1.0e30 outside the root cells
};
struct ReliefMotion {
    float3 position;
    float3 velocity;
    float3 normal;    // of the surface that was hit, or zero
    float distance;   // negative: the particle hit; otherwise position and velocity are unchanged
};
struct ReliefLeaf {  // the leaf of a tree that contains a point
    uint2 record;  // its own record, or that of its split parent if it has none
    float3 q;      // the point in the unit cube of the record's cell
    float cell;    // size of that cell, in roots
    bool inside;   // for leaves without a patch
};
float reliefDot(float3 a, float3 b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}
float reliefRow(float4 row, float3 p) {
    RELIEF_PRECISE float sum = row.x * p.x + (row.y * p.y + (row.z * p.z + row.w));
    return sum;
}
float3 reliefUnit(float3 v) {
    return v * rsqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}
// Returns the point of the octahedron with an index of 0 to 2 half_range in each direction, in index steps.
float3 reliefFold(float2 index, float half_range) {
    float2 st = index - float2(half_range, half_range);
    float z = half_range - abs(st.x) - abs(st.y);
    float beyond = max(-z, 0.0);  // below the equator, both are reflected by their excess
    return float3(st.x - (st.x < 0.0 ? -beyond : beyond), st.y - (st.y < 0.0 ? -beyond : beyond), z);
}
// Returns the two words of a texel.
uint2 reliefPatchTexel(Texture2D<uint4> texels, int index) {
    uint row = uint(index) >> uint(RELIEF_LOG2_WIDTH);
    uint column = uint(index) - (row << uint(RELIEF_LOG2_WIDTH));
    uint4 words = texels.Load(int3(int(column), int(row), 0));
    return uint2(words.x | (words.y << 16u), words.z | (words.w << 16u));
}
int reliefBitCount(uint bits) {
    uint pairs = bits - ((bits >> 1u) & 0x55u);  // of a byte
    uint nibbles = (pairs & 0x33u) + ((pairs >> 2u) & 0x33u);
    return int((nibbles + (nibbles >> 4u)) & 0xfu);
}
// Transforms q into the frame of a patch: u, v and the depth w.
float3 reliefPatchAcross(uint2 record, float3 q) {
    uint diagonal = (record.x >> 5u) & 3u;
    uint axis = (record.x >> 7u) & 3u;
    float3 abc = axis == 0u ? q : axis == 1u ? q.yzx : q.zxy;
    float a = (record.x & 0x200u) != 0u ? 1.0 - abc.x : abc.x;
    float b = (record.x & 0x400u) != 0u ? 1.0 - abc.y : abc.y;
    RELIEF_PRECISE float3 at = float3(b, abc.z, a);
    if (diagonal != 0u) {
        float v = diagonal == 1u ? abc.z : 0.25 * (a + b - 2.0 * abc.z + 2.0);
        float w = diagonal == 1u ? a + b : a + b + abc.z;
        at = float3(0.5 * (a - b + 1.0), v, w);
    }
    return at;
}

// Returns byte i, below 16, of four words.
uint reliefPatchByte(uint4 words, int i) {
    uint low = (i & 4) != 0 ? words.y : words.x;
    uint high = (i & 4) != 0 ? words.w : words.z;
    uint four = i > 7 ? high : low;
    return (four >> uint(8 * (i & 3))) & 0xffu;
}
// Returns the codes at the corners 00, 10, 01 and 11 of a grid square with the lowest corner `corner`.
float4 reliefPatchCodes(Texture2D<uint4> texels, int first, uint2 record, float2 corner, float squares) {
    int side = int(squares) + 1;
    int at = int(corner.y) * side + int(corner.x);
    int end = side * side - 1;
    // The codes lie in two consecutive texels. For 2 by 2 heights, all codes except the last are in the record.
    uint4 words = uint4(record.y, 0u, 0u, 0u);
    if (side > 2) {
        int begin = at / 8;
        int next = min(begin + 1, (end - 1) / 8);
        int heights = first + int(record.y & 0xffffffu);
        words = uint4(reliefPatchTexel(texels, heights + begin), reliefPatchTexel(texels, heights + next));
        at = at - 8 * begin;
        end = end - 8 * begin;
    }
    uint last = at + side + 1 == end ? (record.x >> 23u) & 0xffu : reliefPatchByte(words, at + side + 1);
    return float4(float(reliefPatchByte(words, at)), float(reliefPatchByte(words, at + 1)),
                float(reliefPatchByte(words, at + side)), float(last));
}

// Returns the height of one code step.
float reliefPatchStep(uint2 record) {
    uint scale = record.y >> 24u;
    float power = asfloat(((scale >> 4u) + 115u) << 23u);  // 2^((scale >> 4) - 12); exp2() may round
    return (1.0 + float(scale & 15u) * (1.0 / 16.0)) * power * (1.0 / 255.0);
}
// Returns xyz: the gradient in the cell, of unit length and outwards; w: the distance, in cells.
float4 reliefPatch(Texture2D<uint4> texels, int first, uint2 record, float3 q) {
    uint diagonal = (record.x >> 5u) & 3u;
    uint axis = (record.x >> 7u) & 3u;
    float3 at = reliefPatchAcross(record, q);
    float squares = float(1u << ((record.x >> 2u) & 3u));  // along a side of the grid
    float2 place = at.xy * squares;
    float2 corner = clamp(floor(place), float2(0.0, 0.0), float2(squares - 1.0, squares - 1.0));
    float2 t = place - corner;
    float4 c = reliefPatchCodes(texels, first, record, corner, squares);
    float unit = reliefPatchStep(record);
    float lower = c.x + t.x * (c.y - c.x);
    float upper = c.z + t.x * (c.w - c.z);
    float base = (float((record.x >> 11u) & 0xfffu) - 2048.0) * (1.0 / 512.0);  // height of code 0
    RELIEF_PRECISE float height = base + unit * (lower + t.y * (upper - lower));
    float by_u = (unit * squares) * ((c.y - c.x) + t.y * ((c.w - c.z) - (c.y - c.x)));
    float by_v = (unit * squares) * (upper - lower);
    float3 g = float3(1.0, -by_u, -by_v);
    if (diagonal != 0u) {
        float v = diagonal == 1u ? 0.0 : 0.25 * by_v;
        float w = diagonal == 1u ? -by_v : 1.0 + 0.5 * by_v;
        g = float3(1.0 - 0.5 * by_u - v, 1.0 + 0.5 * by_u - v, w);
    }
    g = float3((record.x & 0x200u) != 0u ? -g.x : g.x, (record.x & 0x400u) != 0u ? -g.y : g.y, g.z);
    g = axis == 0u ? g : axis == 1u ? g.zxy : g.yzx;
    float per_length = rsqrt(reliefDot(g, g)) * ((record.x & 16u) != 0u ? -1.0 : 1.0);
    return float4(per_length * g, (at.z - height) * per_length);
}

// p: map space, within the roots. place: of ReliefCollider.
ReliefLeaf reliefPatchLeaf(Texture2D<uint4> texels, int4 place, float3 p) {
    ReliefLeaf leaf;
    float3 root = floor(p);
    leaf.record = reliefPatchTexel(texels, place.x + 1 + int(root.z) * place.z + int(root.y) * place.y + int(root.x));
    leaf.q = p - root;
    leaf.cell = 1.0;
    leaf.inside = (leaf.record.x & 3u) == 1u;
    bool beside = false;
    for (int level = 0; level < place.w && (leaf.record.x & 3u) == 2u && !beside; level++) {
        float3 child = 2.0 * leaf.q;
        float3 upper = step(float3(1.0, 1.0, 1.0), child);
        uint octant = uint(upper.x + 2.0 * upper.y + 4.0 * upper.z);
        uint children = (leaf.record.x >> 2u) & 0xffu;
        beside = ((children >> octant) & 1u) == 0u;
        if (beside) {
            leaf.inside = ((leaf.record.x >> (10u + octant)) & 1u) != 0u;
        } else {
            int before = reliefBitCount(children & ((1u << octant) - 1u));
            leaf.record = reliefPatchTexel(texels, place.x + int(leaf.record.y & 0xffffffu) + before);
            leaf.q = child - upper;
            leaf.cell = 0.5 * leaf.cell;
            leaf.inside = (leaf.record.x & 3u) == 1u;
        }
    }
    return leaf;
}

// Returns xyz: the normal in map space; w: the distance, in roots. Without `whole`, an outside cell without a patch
// returns 1.0e30, which is faster. p, place: as for reliefPatchLeaf().
float4 reliefPatches(Texture2D<uint4> texels, int4 place, float3 p, bool whole) {
    ReliefLeaf leaf = reliefPatchLeaf(texels, place, p);
    uint2 record = leaf.record;
    float4 vote = float4(0.0, 0.0, 0.0, 1.0e30);
    if ((record.x & 3u) == 3u) {
        bool pair = (record.x & 15u) == 15u;
        int first = place.x + int(record.y & 0xffffffu);
        if (pair) {
            record = reliefPatchTexel(texels, first);
        }
        vote = reliefPatch(texels, place.x, record, leaf.q);
        if (pair) {
            float4 other = reliefPatch(texels, place.x, reliefPatchTexel(texels, first + 1), leaf.q);
            vote = ((leaf.record.x & 16u) != 0u ? other.w > vote.w : other.w < vote.w) ? other : vote;
        }
        vote.w = leaf.cell * vote.w;
    } else if (leaf.inside || whole) {
        bool coarse = (record.x & 3u) == 2u;
        uint s = coarse ? (record.x >> 18u) & 127u : record.x >> 24u;
        uint t = coarse ? record.x >> 25u : (record.x >> 16u) & 255u;
        float3 normal = reliefUnit(reliefFold(float2(float(s), float(t)), coarse ? 63.0 : 127.0));
        float along = reliefDot(normal, leaf.q - float3(0.5, 0.5, 0.5));
        float offset = (float(record.y >> 24u) - 128.0) * (1.0 / 128.0);
        float d = coarse ? leaf.cell * (along + offset) : asfloat(record.y) + leaf.cell * along;
        float nearest = leaf.cell * (1.0 / 1024.0);
        vote = float4(normal, leaf.inside ? min(d, -nearest) : max(d, nearest));
    }
    return vote;
}

// q: map space. roots: number of root cells along x, y and z.
bool reliefInRoots(float3 q, float3 roots) {
    return q.x >= 0.0 && q.y >= 0.0 && q.z >= 0.0 && q.x < roots.x && q.y < roots.y && q.z < roots.z;
}
// As reliefDistance(), but extrapolates the surface up to `reach` beyond the root cells.
ReliefSurface reliefNear(Texture2D<uint4> texels, ReliefCollider collider, float3 p, float reach) {
    ReliefSurface surface;
    surface.normal = float3(0.0, 0.0, 0.0);
    surface.distance = 1.0e30;
    float3 q = float3(reliefRow(collider.row_x, p), reliefRow(collider.row_y, p), reliefRow(collider.row_z, p));
    float3 held = clamp(q, float3(0.0, 0.0, 0.0), 0.99999994 * collider.size.yzw);  // in the root cells
    float3 to = collider.size.x * collider.size.x * (q - held);
    float3 way = collider.row_x.xyz * to.x + (collider.row_y.xyz * to.y + collider.row_z.xyz * to.z);
    bool within = reliefInRoots(q, collider.size.yzw);
    if (within || (reach > 0.0 && reliefDot(way, way) < reach * reach)) {
        float4 vote = collider.size.x * reliefPatches(texels, collider.place, held, true);
        surface.normal = collider.row_x.xyz * vote.x + (collider.row_y.xyz * vote.y + collider.row_z.xyz * vote.z);
        float d = within ? vote.w : vote.w + reliefDot(way, surface.normal);
        surface.distance = vote.w > -3.4e38 ? d : 1.0e30;  // an overflow is not inside
    }
    return surface;
}
ReliefSurface reliefDistance(Texture2D<uint4> texels, ReliefCollider collider, float3 p) {
    return reliefNear(texels, collider, p, 0.0);
}

// Returns a ball's motion after a step to position p with velocity v. If it overlaps the collider, it moves to the
// surface. A velocity into the surface is reflected: restitution (0 to 1) scales its normal component, and 1 - friction
// (0 to 1) its tangential component. With restitution 0 the ball slides; with friction 1 as well, it sticks.
ReliefMotion reliefCollide(Texture2D<uint4> texels, ReliefCollider collider, float3 p, float3 v, float radius,
                           float restitution, float friction) {
    ReliefSurface surface = reliefNear(texels, collider, p, radius);
    ReliefMotion motion;
    motion.position = p;
    motion.velocity = v;
    motion.normal = float3(0.0, 0.0, 0.0);
    motion.distance = surface.distance - radius;
    if (motion.distance < 0.0) {
        float speed = reliefDot(v, surface.normal);
        float3 along = v - speed * surface.normal;
        motion.position = p - motion.distance * surface.normal;
        motion.normal = surface.normal;
        motion.velocity = speed < 0.0 ? (1.0 - friction) * along - (restitution * speed) * surface.normal : v;
    }
    return motion;
}
