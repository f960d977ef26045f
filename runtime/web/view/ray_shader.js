// SPDX-License-Identifier: Apache-2.0
// Casts a ray through a collider without fixed steps, which could miss a thin sheet. Within a texel, the side that a
// map sees changes only where the ray meets the texel's planes or its border. These intersections are computed in
// closed form, as are those with the bilinear surface of a patch. While any map sees outside, the ray is outside, so it
// advances to the end of that map's stretch and evaluates the maps again.
//
//     map 0   ····o───────────────┐                 o: evaluation; each stretch that a map sees outside is one step
//     map 1                       o─────┐
//     map 0                             o──┐        no map sees outside here, and at least one sees inside: a hit
//                                          x━━━━
//
// Inserted after collider.glsl (GpuCollider.glsl). It repeats parts of the votes of collider.glsl; keep them in sync.
export const kRayGlsl = `
uniform float u_tiny;       // minimum step along a ray, object units
uniform int u_steps;        // maximum steps per ray
uniform highp sampler3D u_clear;  // empty space (cells.js)
uniform vec3 u_cells_from;
uniform float u_cell;           // side of a cell

const float NEVER = 1e30;

// A stretch of a ray, from t to end, that a map sees on one side: 1 outside, -1 inside, 0 abstains. border: -1 if the
// stretch ends at a surface; the map axis 0, 1 or 2 if it ends at a border of the texel across that axis.
struct Stretch {
    int side;
    float end;
    int border;
};

// Computes the votes of the two surfaces of a texel. If there is only one, the other vote is far inside.
bool surfaces(ivec4 info, ReliefSight sight, out vec2 votes) {
    bool found;
    votes = vec2(RELIEF_FAR_INSIDE);
    if (reliefIsFrontBack(info)) {
        uvec4 words = texelFetch(u_relief_front_back, reliefTexel(sight.texel, RELIEF_LOG2_WIDTHS.z), 0);
        found = words.b != 0u || (words.a != 0u && !sight.plane);
        float front = reliefFrontBackDepth(info.y, words.b);
        float back = reliefFrontBackDepth(info.y, words.a);
        if (sight.plane) {
            votes = vec2(reliefSightPlane(reliefOctahedron(words.r), front, sight),
                         reliefSightPlane(reliefOctahedron(words.g), back, sight));
        } else {
            votes.x = words.b != 0u ? sight.scale * (front - sight.z) : RELIEF_FAR_INSIDE;
            votes.y = words.a != 0u ? sight.scale * (sight.z - back) : RELIEF_FAR_INSIDE;
        }
    } else {
        votes.x = reliefVoteSingle(info, sight, found).distance;
    }
    return found;
}

// Returns the range where two votes, linear from (t0, f0) to (t1, f1), are both below 0; empty if x > y.
vec2 bothBelow(float t0, float t1, vec2 f0, vec2 f1) {
    vec2 span = vec2(t0, t1);
    for (int k = 0; k < 2; ++k) {
        float at = t0 + (t1 - t0) * (f0[k] / (f0[k] - f1[k]));
        if (f0[k] >= 0.0) {
            span.x = f1[k] < 0.0 ? max(span.x, at) : NEVER;
        } else if (f1[k] >= 0.0) {
            span.y = min(span.y, at);
        }
    }
    return span;
}

// Returns the stretch at t within a texel that ends at t1. span: the inside range, or the outside range if hollow.
Stretch partAt(vec2 span, bool hollow, float t, float t1, int border) {
    float begins = hollow ? span.x : span.x - u_tiny;
    float ends = hollow ? span.y - u_tiny : span.y;
    int within = hollow ? 1 : -1;
    if (span.x >= span.y || t >= ends) {
        return Stretch(-within, t1, border);
    }
    if (t >= begins) {
        return Stretch(within, span.y, span.y < t1 ? -1 : border);
    }
    return Stretch(-within, span.x, -1);
}

// Computes where a ray enters and leaves the range low … high on each axis.
void slabs(vec3 o, vec3 d, vec3 low, vec3 high, out vec3 enters, out vec3 leaves) {
    vec3 inverse = 1.0 / (d + 1e-20 * (vec3(1.0) - abs(sign(d))));
    vec3 a = (low - o) * inverse;
    vec3 b = (high - o) * inverse;
    enters = min(a, b);
    leaves = max(a, b);
}

int leastOf(vec3 v) {
    return v.x <= v.y && v.x <= v.z ? 0 : v.y <= v.z ? 1 : 2;
}

// o, d: origin and direction per unit of t, in map space. far: end of the ray.
Stretch aheadOrthographic(int i, vec3 o, vec3 d, float t, float far) {
    ivec4 info = u_relief_maps[i].info;
    ivec4 place = u_relief_maps[i].place;
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    bool empty_is_outside = reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE);
    vec2 last = vec2(u_relief_maps[i].column[1].w, u_relief_maps[i].column[2].w);
    vec3 enters, leaves;
    slabs(o, d, vec3(1.0, 1.0, 0.0), vec3(last, 1.0), enters, leaves);
    float window = max(enters.x, enters.y);
    float window_ends = min(leaves.x, leaves.y);
    int beyond = encloses ? 1 : 0;
    if (t >= window_ends || window >= window_ends || t < window) {
        bool comes = t < window && window < window_ends;
        return Stretch(beyond, comes ? window : NEVER, comes ? (enters.x > enters.y ? 0 : 1) : -1);
    }
    bool in_depth = t >= enters.z && t < leaves.z;
    float to_depth = t < enters.z ? enters.z : NEVER;
    if (!in_depth && (!encloses || empty_is_outside)) {
        return Stretch(beyond, to_depth, 2);
    }
    // Looks slightly ahead, so that a border belongs to the next texel.
    vec3 q = o + t * d;
    ivec2 at = clamp(ivec2(floor(q.xy + 2e-3 * sign(d.xy))), ivec2(1), ivec2(last) - 1);
    vec3 enters_texel, ends;
    slabs(o, d, vec3(vec2(at), 0.0), vec3(vec2(at) + 1.0, 1.0), enters_texel, ends);
    ends.z = in_depth ? ends.z : to_depth;
    ends = max(ends, t + u_tiny);
    int border = leastOf(ends);
    float t1 = min(min(ends.x, ends.y), min(ends.z, max(far, t + u_tiny)));
    int texel = place.x + at.y * place.y + at.x;
    vec3 across = vec3(vec2(at) + 0.5, 0.0);
    ReliefSight sight = ReliefSight(texel, q.z, reliefIsPlane(info), reliefFromMap(i, q - across),
                                    u_relief_maps[i].column[2].xyz, u_relief_maps[i].object_per_map.z);
    vec2 votes, votes_then;
    bool found = surfaces(info, sight, votes);
    if (!in_depth) {
        return Stretch(found ? 1 : 0, t1, border);
    }
    if (!found) {
        return Stretch(empty_is_outside ? 1 : 0, t1, border);
    }
    vec3 then = o + t1 * d;
    sight.z = then.z;
    sight.from = reliefFromMap(i, then - across);
    surfaces(info, sight, votes_then);
    return partAt(bothBelow(t, t1, votes, votes_then), false, t, t1, border);
}

// Returns (s m, t m, m) on a cube face, where m is the coordinate along the major axis.
vec3 onFace(int face, vec3 v) {
    float way = (face & 1) == 0 ? 1.0 : -1.0;
    return face < 2 ? vec3(-way * v.z, -v.y, way * v.x)
        : face < 4 ? vec3(v.x, way * v.z, way * v.y) : vec3(way * v.x, -v.y, way * v.z);
}

Stretch aheadCube(int i, vec3 o, vec3 d, float t, float far) {
    ivec4 info = u_relief_maps[i].info;
    ivec4 place = u_relief_maps[i].place;
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    bool empty_is_outside = reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE);
    vec3 enters, leaves;
    slabs(o, d, vec3(-1.0), vec3(1.0), enters, leaves);
    float volume = max(max(enters.x, enters.y), enters.z);
    float volume_ends = min(min(leaves.x, leaves.y), leaves.z);
    bool in_volume = t >= volume && t < volume_ends;
    float to_volume = t < volume && volume < volume_ends ? volume : NEVER;
    if (!in_volume && (!encloses || empty_is_outside)) {
        return Stretch(encloses ? 1 : 0, to_volume, -1);
    }
    vec3 q = o + t * d;
    float width = float(place.w);
    vec3 a = abs(q);
    vec3 b = abs(d);
    vec3 ahead = q + (2e-3 * 2.0 / width) * max(max(a.x, a.y), max(a.z, 1e-6)) * d / max(max(b.x, b.y), b.z);
    vec3 st_face = reliefCubeCoordinates(reliefUnit(ahead));
    int face = int(st_face.z);
    ivec2 at = min(ivec2(st_face.xy * width), ivec2(place.w - 1));
    // The borders of a texel are planes through the centre.
    vec3 from = onFace(face, o);
    vec3 way = onFace(face, d);
    float t1 = in_volume ? volume_ends : to_volume;
    for (int k = 0; k < 2; ++k) {
        float low = 2.0 * float(at[k]) / width - 1.0;
        float high = 2.0 * float(at[k] + 1) / width - 1.0;
        float rise = way[k] - low * way.z;
        float fall = high * way.z - way[k];
        t1 = rise < 0.0 ? min(t1, max((low * from.z - from[k]) / rise, t + u_tiny)) : t1;
        t1 = fall < 0.0 ? min(t1, max((from[k] - high * from.z) / fall, t + u_tiny)) : t1;
    }
    t1 = max(min(t1, far), t + u_tiny);
    float depth;
    vec2 index;
    int texel = place.x + face * place.z + at.y * place.y + at.x;
    bool found = reliefFixedTexel(texel, RELIEF_CUBE_DEPTH_MAX, depth, index);
    if (!in_volume) {
        return Stretch(found ? 1 : 0, t1, -1);
    }
    if (!found) {
        return Stretch(empty_is_outside ? 1 : 0, t1, -1);
    }
    if (reliefIsPlane(info)) {
        vec3 ray = reliefUnit(reliefCubeDirection(vec3((vec2(at) + 0.5) / width, st_face.z)));
        vec3 normal = reliefOctahedron(index);
        vec3 ray_object = reliefFromMap(i, ray);
        vec2 votes = vec2(RELIEF_FAR_INSIDE);
        vec2 votes_then = votes;
        votes.x = reliefOctahedralPlane(normal, depth, reliefFromMap(i, q), ray_object);
        votes_then.x = reliefOctahedralPlane(normal, depth, reliefFromMap(i, o + t1 * d), ray_object);
        return partAt(bothBelow(t, t1, votes, votes_then), false, t, t1, -1);
    }
    // A sphere: its interior is inside if the map keeps the farthest surface, otherwise outside.
    float half_way = -reliefDot(o, d) / reliefDot(d, d);
    vec3 nearest = o + half_way * d;
    float left = depth * depth - reliefDot(nearest, nearest);
    float reach = left > 0.0 ? sqrt(left / reliefDot(d, d)) : -1.0;
    vec2 span = vec2(max(half_way - reach, t), min(half_way + reach, t1));
    bool farthest = (info.z & RELIEF_KEEPS_FARTHEST) != 0;
    return partAt(reach < 0.0 ? vec2(NEVER, t) : span, !farthest, t, t1, -1);
}

#if defined(RELIEF_HAS_PATCHES)
// Returns the coefficients f of the height above the bilinear surface of a square: f.x r^2 + f.y r + f.z, with r the
// distance from x along the ray. x, dx: place in the square, and its change with r; z, dz: height above code 0, and its
// change with r; codes: of the corners; unit: height of one code step.
vec3 overSquare(vec2 x, vec2 dx, float z, float dz, vec4 codes, float unit) {
    vec2 by = codes.yz - codes.x;
    float twist = codes.w - codes.z - by.x;
    return vec3(-unit * twist * dx.x * dx.y, dz - unit * (by.x * dx.x + by.y * dx.y + twist * (x.x * dx.y + x.y * dx.x)),
                z - unit * (codes.x + by.x * x.x + by.y * x.y + twist * x.x * x.y));
}

// Returns the first positive zero of f.x r^2 + f.y r + f.z, or NEVER.
float firstZero(vec3 f) {
    float root = f.y * f.y - 4.0 * f.x * f.z;
    float sum = -0.5 * (f.y + (f.y < 0.0 ? -1.0 : 1.0) * sqrt(max(root, 0.0)));
    float one = sum != 0.0 ? f.z / sum : NEVER;
    float other = f.x != 0.0 ? sum / f.x : NEVER;
    float least = min(one > 0.0 ? one : NEVER, other > 0.0 ? other : NEVER);
    return root >= 0.0 ? least : NEVER;
}

const int SQUARES_MAX = 10;  // squares that a ray can cross in a patch: 4 + 3, plus rounding

// Returns the stretch in a patch. The ray is q + s way in the unit cube of the cell, from s = tiny / 2 to ends; the end
// of the result is a value of s. border: of the cell.
Stretch aheadInPatch(int first, uvec2 record, vec3 q, vec3 way, float tiny, float ends, int border) {
    vec3 from = reliefPatchAcross(record, q);
    vec3 across = reliefPatchAcross(record, way) - reliefPatchAcross(record, vec3(0.0));
    from.z -= (float((record.x >> 11u) & 0xfffu) - 2048.0) * (1.0 / 512.0);  // the height of code 0
    float unit = reliefPatchStep(record);
    int above = (record.x & 16u) != 0u ? -1 : 1;
    float here = 0.5 * tiny;
    // There are no intersections above or below all heights.
    float inverse = 1.0 / (across.z + (abs(across.z) < 1e-20 ? 1e-20 : 0.0));
    vec2 range = (vec2(-1.0, 256.0) * unit - from.z) * inverse;
    range = vec2(min(range.x, range.y), max(range.x, range.y));
    bool upper = from.z + here * across.z > 128.0 * unit;
    if (here < range.x || here >= range.y) {
        bool comes = here < range.x && range.x < ends;
        return Stretch(upper ? above : -above, comes ? range.x : ends, comes ? -1 : border);
    }
    float squares = float(1u << ((record.x >> 2u) & 3u));
    vec2 x = squares * from.xy;
    vec2 dx = squares * across.xy;
    vec2 per_square = 1.0 / (dx + 1e-20 * (vec2(1.0) - abs(sign(dx))));
    float last = min(range.y, ends);
    bool over = false;
    for (int k = 0; k < SQUARES_MAX && here < last; ++k) {
        vec2 corner = clamp(floor(x + here * dx), 0.0, squares - 1.0);
        vec2 leaves = max((corner - x) * per_square, (corner + 1.0 - x) * per_square);
        float next = min(max(min(leaves.x, leaves.y), here + 0.5 * tiny), last);
        vec3 f = overSquare(x + here * dx - corner, dx, from.z + here * across.z, across.z,
                            reliefPatchCodes(u_relief_front_back, first, record, corner, squares), unit);
        over = k == 0 ? f.z >= 0.0 : over;
        // If the signs differ, rounding hid the zero in the previous square.
        float zero = here + (over == (f.z >= 0.0) ? firstZero(f) : 0.0);
        if (zero <= next) {
            return Stretch(over ? above : -above, max(zero, tiny), -1);
        }
        here = next;
    }
    return Stretch(over ? above : -above, here < last ? here : ends, here < last ? -1 : border);
}

// Returns the stretch in the patch or the pair of a leaf. In a pair, one side decides: a point is on it if either patch
// votes for it. The loop has a single call, because compilers inline each call.
Stretch aheadInLeaf(int first, uvec2 record, vec3 q, vec3 way, float tiny, float ends, int border) {
    bool pair = (record.x & 15u) == 15u;
    int at = first + int(record.y & 0xffffffu);
    int decides = (record.x & 16u) != 0u ? 1 : -1;
    Stretch stretch = Stretch(0, NEVER, -1);
    for (int k = 0; k < (pair ? 2 : 1); ++k) {
        uvec2 own = pair ? reliefPatchTexel(u_relief_front_back, at + k) : record;
        Stretch one = aheadInPatch(first, own, q, way, tiny, ends, border);
        bool decided = one.side == decides;
        if (k == 0 || (one.side == stretch.side ? decided == (one.end > stretch.end) : decided)) {
            stretch = one;
        }
    }
    return stretch;
}

bool hasNoRecord(ReliefLeaf leaf) {
    return (leaf.record.x & 3u) == 2u;
}

// Advances leaf by leaf through the tree, and from crossing to crossing within a patch.
Stretch aheadPatches(int i, vec3 o, vec3 d, float t, float far) {
    int beyond = reliefHas(u_relief_maps[i].info, RELIEF_ENCLOSES) ? 1 : 0;
    ivec4 place = u_relief_maps[i].place;
    vec3 roots = reliefPatchRoots(i);
    vec3 enters, leaves;
    slabs(o, d, vec3(0.0), roots, enters, leaves);
    float volume = max(max(enters.x, enters.y), enters.z);
    float volume_ends = min(min(leaves.x, leaves.y), leaves.z);
    float next = t + 0.5 * u_tiny;  // slightly ahead, so that a border belongs to the next cell
    if (next < volume || next >= volume_ends) {
        bool comes = next < volume && volume < volume_ends;
        return Stretch(beyond, comes ? max(volume, t + u_tiny) : NEVER, comes ? leastOf(-enters) : -1);
    }
    vec3 p = clamp(o + next * d, vec3(0.0), roots * (1.0 - 1e-6));
    ReliefLeaf leaf = reliefPatchLeaf(u_relief_front_back, place, p);
    vec3 low = p - leaf.cell * leaf.q;
    float cell = leaf.cell;
    if (hasNoRecord(leaf)) {
        cell *= 0.5;
        low += cell * step(vec3(0.5), leaf.q);
    }
    slabs(o, d, low, low + cell, enters, leaves);
    int border = leastOf(leaves);
    float ends = max(min(min(leaves.x, leaves.y), leaves.z), t + u_tiny);
    if ((leaf.record.x & 3u) != 3u) {
        return Stretch(leaf.inside ? -1 : 1, ends, border);
    }
    float size = reliefLength(d);
    float rate = size / cell;
    vec3 q = (o + t * d - low) / cell;
    float room = (min(ends, max(far, t + u_tiny)) - t) * rate;
    Stretch stretch = aheadInLeaf(place.x, leaf.record, q, d / size, u_tiny * rate, room, border);
    stretch.end = t + stretch.end / rate;
    return stretch;
}
#else
Stretch aheadPatches(int i, vec3 o, vec3 d, float t, float far) {
    return Stretch(0, NEVER, -1);
}
#endif

Stretch ahead(int i, vec3 origin, vec3 d, float t, float far) {
    vec3 o = reliefInMap(i, origin);
    vec3 way = vec3(reliefDot(u_relief_maps[i].row[0].xyz, d), reliefDot(u_relief_maps[i].row[1].xyz, d),
                    reliefDot(u_relief_maps[i].row[2].xyz, d));
    if (reliefIsPatches(u_relief_maps[i].info)) {
        return aheadPatches(i, o, way, t, far);
    }
    if (reliefIsCube(u_relief_maps[i].info)) {
        return aheadCube(i, o, way, t, far);
    }
    return aheadOrthographic(i, o, way, t, far);
}

// The first inside point of a ray, or the first outside one.
struct Hit {
    float t;     // NEVER: none
    float ends;  // end of the stretch at t
    int map;     // the last map that saw outside; -1: the ray starts here
    int border;  // as in Stretch
};

// Returns whether a map sees the whole cell of a point outside. ends: where the ray leaves the cell.
bool clearAhead(vec3 origin, vec3 d, float t, out float ends) {
    vec3 o = (origin - u_cells_from) / u_cell;
    vec3 way = d / u_cell;
    vec3 cell = clamp(floor(o + t * way + 1e-3 * sign(d)), vec3(0.0), vec3(textureSize(u_clear, 0)) - 1.0);
    vec3 enters, leaves;
    slabs(o, way, cell, cell + 1.0, enters, leaves);
    ends = max(min(min(leaves.x, leaves.y), leaves.z), t + u_tiny);
    return texelFetch(u_clear, ivec3(cell), 0).r > 0.5;
}

// Follows a ray. d: unit length, object space. inside: search for the first outside point instead of the first inside
// one.
Hit follow(vec3 origin, vec3 d, float t, float far, bool inside) {
    Hit hit = Hit(NEVER, NEVER, -1, -1);
    float cell_ends = t;
    for (int n = 0; n < u_steps && t < far; ++n) {
        if (t >= cell_ends && clearAhead(origin, d, t, cell_ends)) {
            if (inside) {
                hit.t = t;
                return hit;
            }
            t = cell_ends;
            continue;
        }
        float change = NEVER;
        bool sees_inside = false;
        bool sees_outside = false;
        int first = max(hit.map, 0);
        int i = first;
        for (int k = 0; k < u_relief_count.x && !sees_outside; ++k) {
            Stretch stretch = ahead(i, origin, d, t, far);
            sees_outside = stretch.side > 0;
            sees_inside = sees_inside || stretch.side < 0;
            change = sees_outside ? stretch.end : min(change, stretch.end);
            if (sees_outside) {
                hit.map = i;
                hit.border = stretch.border;
            }
            i = k < first ? k : k + 1;
        }
        bool is_inside = sees_inside && !sees_outside;
        if (is_inside != inside) {
            hit.t = t;
            hit.ends = min(change, far);
            return hit;
        }
        t = change;
    }
    return hit;
}
`;
