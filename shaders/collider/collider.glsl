// SPDX-License-Identifier: Apache-2.0
// The method's core: the distance of a point to a collider by its depth maps. formats/depth_map.cpp and
// formats/collider.cpp are the same in C++, formats/README.md in words; all three change together.
//
// ColliderTextures compiles it (collider_block.h: RELIEF_MAP_CAPACITY and so on) and binds all below.
//
//     P --T_i--> P'    orthographic                       cube
//                      z'                                        \  dist  /
//                      |  near                                 \   +--+  /
//                      | +----------+ 0                          \ | \|/   P' in [-1,1]^3
//                      | |   dist   |     f = z_scale *          --+  *--+
//                      | | ~~~~~~~~~|        (dist - z')         / | /|\   f = (|P'| - dist) * |s*d|
//                      v | * P'     |     negative: inside     /   +--+  \   d = P'/|P'|
//                        +----------+ 1
//
// An orthographic map that keeps the farthest surface, and a cube that keeps the nearest, turn the sign. Those
// are the paper's projected distances. In a map of planes f = n*(P - S) instead, with S the surface point on
// the ray through the texel's centre; the normal points outwards, so that no sign turns.

struct ReliefMap {
    vec4 row[3];           // object space to map space, whose rows are orthogonal. Of an orthographic map x and y are
                           // in texels here
    vec4 column[3];        // xyz: an axis of map space in object units, so that they undo the rows; w: 0; width - 1;
                           // height - 1
    vec4 object_per_map;   // xyz; z is z_scale of an orthographic map, xyz the paper's s of a cube. Of patches the size of a
                           // root, and how many there are along x, y and z
    ivec4 place;           // index of texel (0,0) of face 0; from row to row; from face to face; width. Of patches texel 0; from
                           // root to root along y and z; levels
    ivec4 info;            // height; format; flags: the sum of MapFlag; of a live map the index of the
                           // texel (0,0) of its motion, in u_relief_float, whose rows are as wide as that texture
};

// 1: a world of bodies with poses of their own; 0: one collider, in its own object space.
#if !defined(RELIEF_BODIES)
#define RELIEF_BODIES 0
#endif

// 1: some body is live. Its maps are drawn anew before each step, with the motion of the surface beside them.
#if !defined(RELIEF_LIVE)
#define RELIEF_LIVE 0
#endif

ivec2 reliefTexel(int index, int log2_width) {
    return ivec2(index & ((1 << log2_width) - 1), index >> log2_width);
}

#if RELIEF_BODIES > 0
//!layer bodies/world.glsl
#else

layout(std140) uniform ReliefCollider {
    ivec4 u_relief_count;  // maps in use; then RELIEF_LOG2_WIDTHS
    ReliefMap u_relief_maps[RELIEF_MAP_CAPACITY];
};

// In a tour (collider_tour.glsl) each lane of a warp is at a map of its own. A uniform block serves lanes at different
// addresses one after another, shared memory nearly all at once: so the maps below are the work group's copy there, made
// from the same buffer bound as storage, since copying reads different addresses, too. The counts stay in the block.
#if defined(RELIEF_TOUR)
layout(std140, binding = RELIEF_TOUR_STORAGE) readonly buffer ReliefColliderStorage {
    ivec4 b_relief_count;
    ReliefMap b_relief_maps[RELIEF_MAP_CAPACITY];
};
shared ReliefMap s_relief_maps[RELIEF_MAP_CAPACITY];

// Called first, by every invocation of a group of so many lanes.
void reliefShare(int lane, int lanes) {
    for (int i = lane; i < RELIEF_MAP_CAPACITY; i += lanes) {
        s_relief_maps[i] = b_relief_maps[i];
    }
    memoryBarrierShared();
    barrier();
}

#define u_relief_maps s_relief_maps
#endif

#define reliefMapRow(i, k) u_relief_maps[i].row[k]
#define reliefMapColumn(i, k) u_relief_maps[i].column[k]
#define reliefObjectPerMap(i) u_relief_maps[i].object_per_map
#define reliefMapPlace(i) u_relief_maps[i].place
#define reliefMapInfo(i) u_relief_maps[i].info
#endif

// Texels of all maps in a row, wrapped at the texture's width: texel i is at (i mod width, i / width). So maps of
// any sizes lie together without a gap. RELIEF_LOG2_WIDTHS: log2 of the widths, which every texel needs.
uniform highp sampler2D u_relief_float;
uniform highp sampler2D u_relief_fixed;
uniform highp usampler2D u_relief_front_back;

// 1: a texel of planes may hold one end alone. ColliderTextures gives the empty end of a stored one the plane of the other,
// which changes no vote; the maps of live bodies are as drawn.
#define RELIEF_HALF_EMPTY (RELIEF_LIVE == 1)

// The kind of a map, constant where all are alike: a GL may otherwise run the branches of all formats for every map.
// ColliderTextures defines RELIEF_HAS_... for the kinds present.
bool reliefIsCube(ivec4 info) {
#if !defined(RELIEF_HAS_CUBE)
    return false;
#elif defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED) || defined(RELIEF_HAS_FRONT_BACK)
    return info.y == RELIEF_MAP_FORMAT_CUBE8;
#else
    return true;
#endif
}

// Asked before the other kinds.
bool reliefIsPatches(ivec4 info) {
#if !defined(RELIEF_HAS_PATCHES)
    return false;
#elif defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED) || defined(RELIEF_HAS_CUBE) || defined(RELIEF_HAS_FRONT_BACK)
    return info.y == RELIEF_MAP_FORMAT_PATCHES;
#else
    return true;
#endif
}

bool reliefIsFrontBack(ivec4 info) {  // of an orthographic map, as is the next one
#if !defined(RELIEF_HAS_FRONT_BACK)
    return false;
#elif defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED)
    return info.y == RELIEF_MAP_FORMAT_FRONT_BACK_HALF || info.y == RELIEF_MAP_FORMAT_FRONT_BACK_FIXED;
#else
    return true;
#endif
}

bool reliefIsFloat(ivec4 info) {
#if !defined(RELIEF_HAS_FLOAT)
    return false;
#else
    return info.y == RELIEF_MAP_FORMAT_FLOAT32;
#endif
}

bool reliefIsPlane(ivec4 info) {
#if !defined(RELIEF_HAS_PLANE)
    return false;
#elif defined(RELIEF_HAS_PROJECTED)
    return (info.z & RELIEF_DECODES_PLANE) != 0;
#else
    return true;
#endif
}

// The flags that every map has.
#if !defined(RELIEF_ALL)
#define RELIEF_ALL 0
#endif

bool reliefHas(ivec4 info, int flag) {
    return (RELIEF_ALL & flag) != 0 || (info.z & flag) != 0;
}

// The combined vote. map is the deciding map, -1 where every map abstains; normal is zero where nothing but "outside"
// is known (distance RELIEF_FAR_OUTSIDE).
struct ReliefField {
    float distance;
    vec3 normal;
    int map;
};

bool reliefInside(ReliefField field) {
    return field.map >= 0 && field.distance < 0.0;
}

// Rule 2 of the paper: outside as soon as one map sees P outside; the smallest positive or the largest
// negative vote wins. A vote of 0 is outside, so that the order of the maps does not matter.
bool reliefReplaces(float vote, float best) {
    return (best < 0.0 && vote > best) || (vote >= 0.0 && vote < best);
}

// Equation 3: indices 0...2 half_range in each direction to the octahedron, of which the sphere's point is reliefUnit(). In
// steps of the index, so that all of it is exact. shaderTexels() leaves no index 255.
vec3 reliefFold(vec2 index, float half_range) {
    vec2 st = index - half_range;
    float z = half_range - abs(st.x) - abs(st.y);
    // Below the equator both are reflected by their excess.
    uint beyond = floatBitsToUint(max(-z, 0.0));
    return vec3(st.x - uintBitsToFloat(beyond | (floatBitsToUint(st.x) & 0x80000000u)),
                st.y - uintBitsToFloat(beyond | (floatBitsToUint(st.y) & 0x80000000u)), z);
}

vec3 reliefOctahedron(vec2 index) {
    return reliefFold(index, float(RELIEF_NORMAL_HALF_RANGE));
}

vec3 reliefOctahedron(uint code) {
    return reliefOctahedron(vec2(float(code >> 8), float(code & 255u)));
}

vec3 reliefUnit(vec3 v) {
    return v * inversesqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

float reliefRow(vec4 r, vec3 p) {
    return r.x * p.x + (r.y * p.y + (r.z * p.z + r.w));
}

// A point of object space in the space of map i.
vec3 reliefInMap(int i, vec3 p) {
    return vec3(reliefRow(reliefMapRow(i, 0), p), reliefRow(reliefMapRow(i, 1), p),
                reliefRow(reliefMapRow(i, 2), p));
}

// True for a point p of an orthographic map's own space above its texels, without its rim, which is empty.
bool reliefInWindow(int i, vec3 p) {
    return p.x >= 1.0 && p.y >= 1.0 && p.x < reliefMapColumn(i, 1).w && p.y < reliefMapColumn(i, 2).w;
}

bool reliefInDepth(vec3 p) {
    return p.z >= 0.0 && p.z <= 1.0;
}

// In the order of the CPU's twin: the order of dot() is the driver's choice.
float reliefDot(vec3 a, vec3 b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}

float reliefLength(vec3 v) {
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// The face that d meets and the place on it, OpenGL's rule; x wins over y over z among equals. By hand on
// six layers, so that every GL picks the same texel as the CPU and no seam is filtered.
vec3 reliefCubeCoordinates(vec3 d) {
    vec3 a = abs(d);
    float face, sc, tc, major;
    if (a.x >= a.y && a.x >= a.z) {
        face = d.x < 0.0 ? 1.0 : 0.0;
        sc = d.x < 0.0 ? d.z : -d.z;
        tc = -d.y;
        major = a.x;
    } else if (a.y >= a.z) {
        face = d.y < 0.0 ? 3.0 : 2.0;
        sc = d.x;
        tc = d.y < 0.0 ? -d.z : d.z;
        major = a.y;
    } else {
        face = d.z < 0.0 ? 5.0 : 4.0;
        sc = d.z < 0.0 ? -d.x : d.x;
        tc = -d.y;
        major = a.z;
    }
    return vec3(0.5 * (sc / major + 1.0), 0.5 * (tc / major + 1.0), face);
}

// The direction, of largest component 1, through (s, t) of a face.
vec3 reliefCubeDirection(vec3 st_face) {
    vec2 c = 2.0 * st_face.xy - 1.0;
    int face = int(st_face.z);
    float way = (face & 1) == 0 ? 1.0 : -1.0;
    vec3 d = vec3(way * c.x, -c.y, way);
    if (face < 2) {
        d = vec3(way, -c.y, -way * c.x);
    } else if (face < 4) {
        d = vec3(c.x, way, way * c.y);
    }
    return d;
}

// From map space to object space, directions alone.
vec3 reliefFromMap(int i, vec3 q) {
    return reliefMapColumn(i, 0).xyz * q.x +
           (reliefMapColumn(i, 1).xyz * q.y + reliefMapColumn(i, 2).xyz * q.z);
}

// The vote of a plane: n*(P - S). along_normal: n times 1 / per_length; from: P - O, with O where the ray of the texel's centre
// has depth 0; ray: its direction, for a unit of depth.
float reliefPlane(vec3 along_normal, float per_length, float depth, vec3 from, vec3 ray) {
    float along = per_length * reliefDot(along_normal, ray);
    return per_length * reliefDot(along_normal, from) - depth * along;
}

float reliefOctahedralPlane(vec3 along_normal, float depth, vec3 from, vec3 ray) {
    return reliefPlane(along_normal, inversesqrt(reliefDot(along_normal, along_normal)), depth, from, ray);
}

// A half-float depth: a positive normal half, whose exponent's bias is moved from 15 to 127. By hand, since
// GLSL 3.30 has no unpackHalf2x16.
float reliefHalf(uint bits) {
    return uintBitsToFloat((bits << 13) + (112u << 23));
}

float reliefFrontBackDepth(int format, uint code) {
#if !defined(RELIEF_HAS_FRONT_BACK_FIXED)
    return reliefHalf(code);
#else
    float fixed_point = (float(code) - 1.0) * (1.0 / float(RELIEF_DEPTH_STEPS));
#if defined(RELIEF_HAS_FRONT_BACK_HALF)
    return format == RELIEF_MAP_FORMAT_FRONT_BACK_HALF ? reliefHalf(code) : fixed_point;
#else
    return fixed_point;
#endif
#endif
}

// R,G: normal; B,A: 16-bit fixed-point depth, 0 where empty. Of the normal the indices.
bool reliefFixedTexel(int index, float depth_max, out float depth, out vec2 normal) {
    vec4 bytes = floor(texelFetch(u_relief_fixed, reliefTexel(index, RELIEF_LOG2_WIDTHS.y), 0) * 255.0 + 0.5);
    float code = bytes.b * 256.0 + bytes.a;
    depth = (code - 1.0) * (depth_max / float(RELIEF_DEPTH_STEPS));
    normal = bytes.rg;
    return code > 0.0;
}

// A normal as a texel holds it: of all fetched only the deciding one is decoded. A patch has none but by its heights.
#if defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_PATCHES)
#define RELIEF_CODE vec3
const vec3 RELIEF_NO_CODE = vec3(0.0);
vec3 reliefCode(uint code) {
    return reliefUnit(reliefOctahedron(code));
}
vec3 reliefCode(vec2 index) {
    return reliefUnit(reliefOctahedron(index));
}
vec3 reliefDecode(vec3 code) {
    return code;
}
#else
#define RELIEF_CODE uint
const uint RELIEF_NO_CODE = 0u;
uint reliefCode(uint code) {
    return code;
}
uint reliefCode(vec2 index) {
    return (uint(index.x) << 8) | uint(index.y);
}
vec3 reliefDecode(uint code) {
    return reliefUnit(reliefOctahedron(code));
}
#endif

// The vote of one map: RELIEF_FAR_INSIDE where it abstains, which never wins.
struct ReliefVote {
    float distance;
    RELIEF_CODE normal;
};

float reliefEmpty(ivec4 info) {
    return reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE) ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE;
}

// No function that every particle runs returns early: a GL may make a loop of each that does.

// A point of an orthographic map relative to the ray through its texel's centre.
struct ReliefSight {
    int texel;    // its index
    float z;      // depth of the point
    bool plane;   // the map decodes planes
    vec3 from;    // as reliefPlane() takes them
    vec3 ray;
    float scale;  // z_scale
};

float reliefSightPlane(vec3 along_normal, float depth, ReliefSight sight) {
    return reliefOctahedralPlane(along_normal, depth, sight.from, sight.ray);
}

float reliefSightProjected(ivec4 info, float depth, ReliefSight sight) {
    return sight.scale * ((info.z & RELIEF_KEEPS_FARTHEST) != 0 ? sight.z - depth : depth - sight.z);
}

// The votes of a texel of each kind; without meaning where none is found.

// Outside where either surface votes so.
ReliefVote reliefVoteFrontBack(ivec4 info, ReliefSight sight, bool whole, out bool found) {
    uvec4 words = texelFetch(u_relief_front_back, reliefTexel(sight.texel, RELIEF_LOG2_WIDTHS.z), 0);
    // In integers, which takes fewer instructions than a conjunction of conditions.
    uint depths = !sight.plane || RELIEF_HALF_EMPTY ? words.b | words.a : words.b;
    found = depths != 0u;
    float front = reliefFrontBackDepth(info.y, words.b);
    float back = reliefFrontBackDepth(info.y, words.a);
    if (sight.plane) {
        front = reliefSightPlane(reliefOctahedron(words.r), front, sight);
        back = reliefSightPlane(reliefOctahedron(words.g), back, sight);
    } else {
        front = sight.scale * (front - sight.z);
        back = sight.scale * (sight.z - back);
    }
    if (!sight.plane || RELIEF_HALF_EMPTY) {
        front = words.b != 0u ? front : RELIEF_FAR_INSIDE;
        back = words.a != 0u ? back : RELIEF_FAR_INSIDE;
    }
    float distance = max(front, back);
    if (whole) {
        distance = reliefReplaces(back, front) ? back : front;
    }
    return ReliefVote(distance, reliefCode(distance == front ? words.r : words.g));
}

ReliefVote reliefVoteFixed(ivec4 info, ReliefSight sight, out bool found) {
    float depth;
    vec2 index;
    found = reliefFixedTexel(sight.texel, 1.0, depth, index);
    float distance = sight.plane ? reliefSightPlane(reliefOctahedron(index), depth, sight)
                                 : reliefSightProjected(info, depth, sight);
    return ReliefVote(distance, reliefCode(index));
}

#if defined(RELIEF_HAS_FLOAT)
// A float map's normals count as they are.
ReliefVote reliefVoteFloat(ivec4 info, ReliefSight sight, out bool found) {
    vec4 values = texelFetch(u_relief_float, reliefTexel(sight.texel, RELIEF_LOG2_WIDTHS.x), 0);
    found = values.a >= 0.0;
    float distance = sight.plane ? reliefPlane(values.rgb, 1.0, values.a, sight.from, sight.ray)
                                 : reliefSightProjected(info, values.a, sight);
    return ReliefVote(distance, values.rgb);
}
#else
ReliefVote reliefVoteFloat(ivec4 info, ReliefSight sight, out bool found) {
    found = false;
    return ReliefVote(RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
}
#endif

// Without `whole` any distance that is not below 0 stands for all of them.
ReliefVote reliefVoteOrthographic(int i, vec3 p, ivec4 place, ivec4 info, bool whole) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    ReliefVote vote = ReliefVote(encloses ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
    bool in_window = reliefInWindow(i, p);
    bool in_depth = reliefInDepth(p);
    // Before and behind the volume the texel gives only the distance, or that the map abstains.
    bool sees_beyond = encloses && (whole || !reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE));
    if (in_window && (in_depth || sees_beyond)) {
        ivec2 at = ivec2(p.xy);
        ReliefSight sight = ReliefSight(place.x + at.y * place.y + at.x, p.z, reliefIsPlane(info),
                                        reliefFromMap(i, vec3(p.xy - (vec2(at) + 0.5), p.z)),
                                        reliefMapColumn(i, 2).xyz, reliefObjectPerMap(i).z);
        bool found;
        if (reliefIsFrontBack(info)) {
            vote = reliefVoteFrontBack(info, sight, whole, found);
        } else if (reliefIsFloat(info)) {
            vote = reliefVoteFloat(info, sight, found);
        } else {
            vote = reliefVoteFixed(info, sight, found);
        }
        if (sees_beyond && !in_depth && !(vote.distance >= 0.0)) {  // nothing of the collider remains there
            vote.distance = RELIEF_FAR_OUTSIDE;
        }
        vote.distance = found ? vote.distance : reliefEmpty(info);
    }
    return vote;
}

ReliefVote reliefVoteCube(int i, vec3 p, ivec4 place, ivec4 info) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    ReliefVote vote = ReliefVote(encloses ? RELIEF_FAR_OUTSIDE : RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
    bool in_volume = all(lessThanEqual(abs(p), vec3(1.0)));
    // The squares below must not overflow.
    if (in_volume || (encloses && all(lessThanEqual(abs(p), vec3(1e15))))) {
        float radius = reliefLength(p);
        vec3 direction = radius > 0.0 ? p / radius : vec3(1.0, 0.0, 0.0);
        vec3 st_face = reliefCubeCoordinates(direction);
        ivec2 at = min(ivec2(st_face.xy * float(place.w)), ivec2(place.w - 1));
        float depth;
        vec2 index;
        int texel = place.x + int(st_face.z) * place.z + at.y * place.y + at.x;
        bool found = reliefFixedTexel(texel, RELIEF_CUBE_DEPTH_MAX, depth, index);
        vote.normal = reliefCode(index);
        if (reliefIsPlane(info)) {
            vec3 ray = reliefUnit(reliefCubeDirection(vec3((vec2(at) + 0.5) / float(place.w), st_face.z)));
            vote.distance = reliefOctahedralPlane(reliefOctahedron(index), depth, reliefFromMap(i, p), reliefFromMap(i, ray));
        } else {
            float ahead = (info.z & RELIEF_KEEPS_FARTHEST) != 0 ? radius - depth : depth - radius;
            vote.distance = ahead * reliefLength(reliefObjectPerMap(i).xyz * direction);
        }
        if (!in_volume && !(vote.distance >= 0.0)) {
            vote.distance = RELIEF_FAR_OUTSIDE;
        }
        vote.distance = found ? vote.distance : reliefEmpty(info);
    }
    return vote;
}

#if defined(RELIEF_HAS_PATCHES)
//!include collider/patches.glsl
#else
vec3 reliefPatchRoots(int i) {
    return vec3(0.0);
}
ReliefVote reliefVotePatches(int i, ivec4 info, vec3 p, bool whole) {
    return ReliefVote(RELIEF_FAR_INSIDE, RELIEF_NO_CODE);
}
#endif

ReliefVote reliefVoteOf(int i, ivec4 info, vec3 p, bool whole) {
    vec3 in_map = reliefInMap(i, p);
    ivec4 place = reliefMapPlace(i);
    ReliefVote vote;
    if (reliefIsPatches(info)) {
        vote = reliefVotePatches(i, info, in_map, whole);
    } else if (reliefIsCube(info)) {
        vote = reliefVoteCube(i, in_map, place, info);
    } else {
        vote = reliefVoteOrthographic(i, in_map, place, info, whole);
    }
    return vote;
}

ReliefVote reliefVote(int i, vec3 p, bool whole) {
    return reliefVoteOf(i, reliefMapInfo(i), p, whole);
}

// The votes so far: of none the map is -1.
struct ReliefBest {
    float distance;
    RELIEF_CODE normal;
    int map;
};
const ReliefBest RELIEF_NO_VOTE = ReliefBest(RELIEF_FAR_INSIDE, RELIEF_NO_CODE, -1);

void reliefJoin(inout ReliefBest best, int i, ivec4 info, vec3 p, bool whole) {
    ReliefVote vote = reliefVoteOf(i, info, p, whole);
    // Without `whole` the best one is below 0 so far.
    if (whole ? reliefReplaces(vote.distance, best.distance) : vote.distance > best.distance) {
        best = ReliefBest(vote.distance, vote.normal, i);
    }
}

ReliefField reliefFieldOf(ReliefBest best) {
    bool known = best.map >= 0 && best.distance < RELIEF_FAR_OUTSIDE;
    return ReliefField(best.distance, known ? reliefDecode(best.normal) : vec3(0.0), best.map);
}

// The maps [first, end) alone, as reliefSolid or, with `whole`, reliefEvaluate.
ReliefField reliefMaps(int first, int end, vec3 p, bool whole) {
    ReliefBest best = RELIEF_NO_VOTE;
    for (int i = first; i < end && (whole || best.distance < 0.0); ++i) {
        reliefJoin(best, i, reliefMapInfo(i), p, whole);
    }
    return reliefFieldOf(best);
}

// From p to the nearest point of the volume of map i; zero where p is in it.
vec3 reliefToVolume(int i, vec3 p) {
    vec3 in_map = reliefInMap(i, p);
    vec3 low = vec3(-1.0);
    vec3 high = vec3(1.0);
    if (reliefIsPatches(reliefMapInfo(i))) {
        low = vec3(0.0);
        high = reliefPatchRoots(i);
    } else if (!reliefIsCube(reliefMapInfo(i))) {  // its rim has nothing
        low = vec3(1.0, 1.0, 0.0);
        high = vec3(reliefMapColumn(i, 1).w, reliefMapColumn(i, 2).w, 1.0);
    }
    return reliefFromMap(i, clamp(in_map, low, high) - in_map);
}

// The maps [first, end) of a point that is inside; any distance that is not below 0 stands for all others. Map `start` is
// first: it saw p from near, and most often knows that it is outside.
ReliefBest reliefProbe(int first, int end, int start, vec3 p) {
    ReliefBest best = RELIEF_NO_VOTE;
    int i = start;
    for (int k = first; k < end && best.distance < 0.0; ++k) {
        ReliefVote vote = reliefVote(i, p, false);
        // Of equal votes that of the first map counts, as in reliefMaps().
        if (vote.distance > best.distance || (vote.distance == best.distance && i < best.map)) {
            best = ReliefBest(vote.distance, vote.normal, i);
        }
        i = k < start ? k : k + 1;
    }
    return best;
}

// The surface that a ball is in or touches. Where its centre is inside, as reliefSolid() of that, and deeper by the radius. Else
// each map that sees a surface near gives the direction to it, and the point of the ball there is evaluated; the deepest such
// point decides, with a distance below 0. Where it touches nothing: RELIEF_FAR_OUTSIDE, or where all maps abstain, no map.
ReliefField reliefBall(int first, int end, vec3 center, float radius) {
    ReliefBest inside = RELIEF_NO_VOTE;
    ReliefField touched = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    for (int i = first; i < end; ++i) {
        ReliefVote vote = reliefVote(i, center, true);
        if (vote.distance > inside.distance) {
            inside = ReliefBest(vote.distance, vote.normal, i);
        }
        // A projected distance may be some times the distance.
        bool seen = vote.distance >= 0.0 && vote.distance < 4.0 * radius;
        vec3 way = reliefToVolume(i, center);
        float apart = reliefLength(way);
        if (seen || (apart > 0.0 && apart < radius)) {
            vec3 normal = seen ? reliefDecode(vote.normal) : -way / apart;
            ReliefBest probe = reliefProbe(first, end, i, center - radius * normal);
            if (probe.map >= 0 && probe.distance < 0.0 && probe.distance < touched.distance) {
                touched = ReliefField(probe.distance, seen ? reliefDecode(probe.normal) : normal, probe.map);
            }
        }
    }
    if (inside.map >= 0 && inside.distance < 0.0) {  // WebGL has no ?: of structures
        touched = reliefFieldOf(inside);
        touched.distance -= radius;
    }
    return touched;
}

#if RELIEF_BODIES == 0

// Of all maps, in the object space that they share.
ReliefField reliefEvaluate(vec3 p) {
    return reliefMaps(0, u_relief_count.x, p, true);
}

// Its format and flags are numbers here: a compiler that reads them in the block keeps the code of every format for every
// map, and a GL may run it.
#define RELIEF_VOTE_OF(n, format, flags) \
    if (best.distance < 0.0) { \
        reliefJoin(best, n, ivec4(reliefMapInfo(n).x, format, flags, reliefMapInfo(n).w), p, false); \
    }

// For a step of a simulation: the same as reliefEvaluate where P is inside; where it is not, the first map that sees it
// outside ends the loop, so that most points cost one fetch however many maps there are. (Rule 2 never turns a vote >= 0
// into one below.) The first maps have constant indices, so that GPUs need not index the block for them.
ReliefField reliefSolid(vec3 p) {
    ReliefBest best = RELIEF_NO_VOTE;
    RELIEF_VOTES
#if RELIEF_MAP_CAPACITY > RELIEF_UNROLLED_MAPS
    for (int i = RELIEF_UNROLLED_MAPS; i < u_relief_count.x && best.distance < 0.0; ++i) {
        reliefJoin(best, i, reliefMapInfo(i), p, false);
    }
#endif
    return reliefFieldOf(best);
}

// reliefInside(reliefSolid(p)) with map `first` before the others: the map that decides nearby most often knows that p is
// outside. With a few maps constants are cheaper than what that order saves.
bool reliefSolidAt(vec3 p, int first) {
#if RELIEF_MAP_CAPACITY <= 4
    return reliefInside(reliefSolid(p));
#else
    float best = RELIEF_FAR_INSIDE;
    int i = first;
    for (int k = 0; k < u_relief_count.x && best < 0.0; ++k) {
        best = max(best, reliefVote(i, p, false).distance);
        i = k < first ? k : k + 1;
    }
    return best < 0.0 && best > RELIEF_FAR_INSIDE;
#endif
}

#else

//!layer bodies/bodies.glsl

#endif
