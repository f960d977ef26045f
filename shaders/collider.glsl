// The method's core: what the depth maps of a collider say of a point. formats/depth_map.cpp and
// formats/collider.cpp are the same in C++, formats/README.md in words; all three change together.
//
// Needs RELIEF_MAP_CAPACITY, the length of the block's array; ColliderTextures gives it, and binds all below.
//
//     P ──T_i──▶ P'    orthographic                       cube
//                      z'                                        ╲  dist  ╱
//                      │  near                                 ╲   ┌──┐  ╱
//                      │ ┌──────────┐ 0                          ╲ │ ╲│╱   P' in [−1,1]³
//                      │ │   dist   │     f = z_scale·           ──┤  ●──┤
//                      │ │ ~~~~~~~~~│        (dist − z')         ╱ │ ╱│╲   f = (|P'| − dist)·|s∘d|
//                      ▼ │ ● P'     │     negative: inside     ╱   └──┘  ╲   d = P'/|P'|
//                        └──────────┘ 1
//
// An orthographic map that keeps the farthest surface, and a cube that keeps the nearest, turn the sign. Those
// are the paper's projected distances. A map of planes says f = n·(P − S) instead, with S the surface point on
// the ray through the texel's centre; the normal points outwards, so that no sign turns. A plane along the ray has
// no such S: its texel holds how far it is from the ray.

struct ReliefMap {
    vec4 row[3];           // object_to_map; rows are orthogonal
    vec4 column[3];        // xyz: an axis of map space in object units, so that they undo the rows; w: the
                           // largest offset of a standing plane; 1 / width; 1 / height
    vec4 object_per_map;   // xyz; z is z_scale of an orthographic map, xyz the paper's s of a cube; w: the
                           // largest product of an orthographic ray and the normal of a plane along it
    ivec4 place;           // index of texel (0,0) of face 0; from row to row; from face to face; width
    ivec4 info;            // height; format; flags: the sum of RELIEF_KEEPS_FARTHEST…; of a live map the index of the
                           // texel (0,0) of its motion, in u_relief_float, whose rows are as wide as that texture
};

// Colliders with a pose of their own; 0: one collider, in its own object space.
#if !defined(RELIEF_BODIES)
#define RELIEF_BODIES 0
#endif

// Whether some body is live: its maps are drawn anew before each step, with the motion of the surface beside them.
#if !defined(RELIEF_LIVE)
#define RELIEF_LIVE 0
#endif

#if RELIEF_BODIES > 0
struct ReliefBody {
    vec4 row[3];     // world to object space at the end of the step: a rotation, divided by scale
    vec4 before[3];  // the same at its beginning
    vec4 response;   // scale (world units of an object unit); restitution; 1 - friction
    ivec4 maps;      // the first map; how many; 1 if they are live
};
#endif

layout(std140) uniform ReliefCollider {
    ivec4 u_relief_count;  // maps in use; log2 of the widths of the textures: float, fixed, front-back
#if RELIEF_BODIES > 0
    ReliefBody u_relief_bodies[RELIEF_BODIES];
#endif
    ReliefMap u_relief_maps[RELIEF_MAP_CAPACITY];
};

// Texels of all maps in a row, wrapped at the texture's width: texel i is at (i mod width, i / width). So maps of
// any sizes lie together without a gap.
uniform highp sampler2D u_relief_float;
uniform highp sampler2D u_relief_fixed;
uniform highp usampler2D u_relief_front_back;

const int RELIEF_FLOAT32 = 0;
const int RELIEF_FIXED8 = 1;
const int RELIEF_FRONT_BACK_HALF = 2;
const int RELIEF_CUBE8 = 3;
const int RELIEF_FRONT_BACK_FIXED = 4;

const int RELIEF_KEEPS_FARTHEST = 1;
const int RELIEF_ENCLOSES = 2;
const int RELIEF_EMPTY_IS_OUTSIDE = 4;
const int RELIEF_PLANE = 8;

const float RELIEF_FAR_INSIDE = -3.4028235e38;
const float RELIEF_FAR_OUTSIDE = 1e30;
const float RELIEF_CUBE_DEPTH_MAX = 1.7320509;
const float RELIEF_STANDING_COSINE = 0.03125;

// What the maps of this collider are, as constants where they are all alike: a GL may otherwise run the branches
// of all formats for every map. ColliderTextures defines RELIEF_HAS_… for what it holds.
bool reliefIsCube(ivec4 info) {
#if !defined(RELIEF_HAS_CUBE)
    return false;
#elif defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED) || defined(RELIEF_HAS_FRONT_BACK)
    return info.y == RELIEF_CUBE8;
#else
    return true;
#endif
}

bool reliefIsFrontBack(ivec4 info) {  // of an orthographic map, as is the next one
#if !defined(RELIEF_HAS_FRONT_BACK)
    return false;
#elif defined(RELIEF_HAS_FLOAT) || defined(RELIEF_HAS_FIXED)
    return info.y == RELIEF_FRONT_BACK_HALF || info.y == RELIEF_FRONT_BACK_FIXED;
#else
    return true;
#endif
}

bool reliefIsFloat(ivec4 info) {
#if !defined(RELIEF_HAS_FLOAT)
    return false;
#else
    return info.y == RELIEF_FLOAT32;
#endif
}

bool reliefIsPlane(ivec4 info) {
#if !defined(RELIEF_HAS_PLANE)
    return false;
#elif defined(RELIEF_HAS_PROJECTED)
    return (info.z & RELIEF_PLANE) != 0;
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

// The combined vote. map is the deciding map, −1 where every map abstains; normal is zero where the point
// is known to be outside and no more (distance RELIEF_FAR_OUTSIDE).
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

// Equation 3: indices 0…254 in each direction to the octahedron, to the sphere.
vec3 reliefNormal(vec2 index) {
    vec2 st = (min(index, vec2(254.0)) - 127.0) / 127.0;
    vec3 v = vec3(st, 1.0 - abs(st.x) - abs(st.y));
    if (v.z < 0.0) {
        v.x = (st.x < 0.0 ? -1.0 : 1.0) * (1.0 - abs(st.y));
        v.y = (st.y < 0.0 ? -1.0 : 1.0) * (1.0 - abs(st.x));
    }
    return v / sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

float reliefRow(vec4 r, vec3 p) {
    return r.x * p.x + (r.y * p.y + (r.z * p.z + r.w));
}

// In the order of the CPU's twin: what dot() adds first is the driver's choice.
float reliefDot(vec3 a, vec3 b) {
    return a.x * b.x + (a.y * b.y + a.z * b.z);
}

float reliefLength(vec3 v) {
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// The face that d meets and where on it, OpenGL's rule; x wins over y over z among equals. Done by hand on
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
    if (face == 0) {
        return vec3(1.0, -c.y, -c.x);
    } else if (face == 1) {
        return vec3(-1.0, -c.y, c.x);
    } else if (face == 2) {
        return vec3(c.x, 1.0, c.y);
    } else if (face == 3) {
        return vec3(c.x, -1.0, -c.y);
    } else if (face == 4) {
        return vec3(c.x, -c.y, 1.0);
    }
    return vec3(-c.x, -c.y, -1.0);
}

// From map space to object space, directions alone.
vec3 reliefFromMap(int i, vec3 q) {
    return u_relief_maps[i].column[0].xyz * q.x +
           (u_relief_maps[i].column[1].xyz * q.y + u_relief_maps[i].column[2].xyz * q.z);
}

// The vote of a plane: n·(P − S), or n·(P − O) less the stored offset where the plane stands along the ray.
// from: P − O, with O where the ray of the texel's centre has depth 0; ray: its direction, for a unit of depth;
// standing: its length times RELIEF_STANDING_COSINE; depth: from 0 to depth_max.
float reliefPlane(int i, vec3 normal, float depth, float depth_max, vec3 from, vec3 ray, float standing) {
    float along = reliefDot(normal, ray);
    float range = u_relief_maps[i].column[0].w;
    bool stands = abs(along) < standing;
    float slope = stands ? range * (2.0 / depth_max) : along;
    float base = stands ? range : 0.0;
    return reliefDot(normal, from) - (depth * slope - base);
}

void reliefAdd(inout ReliefField best, float distance, vec3 normal, int map) {
    if (reliefReplaces(distance, best.distance)) {
        best = ReliefField(distance, normal, map);
    }
}

// A half-float depth: a positive normal half, whose exponent's bias is moved from 15 to 127. By hand, since
// GLSL 3.30 has no unpackHalf2x16.
float reliefHalf(uint bits) {
    return uintBitsToFloat((bits << 13) + (112u << 23));
}

float reliefFrontBackDepth(int format, uint code) {
    return format == RELIEF_FRONT_BACK_HALF ? reliefHalf(code) : (float(code) - 1.0) * (1.0 / 65534.0);
}

vec3 reliefPackedNormal(uint packed_normal) {
    return reliefNormal(vec2(float(packed_normal >> 8), float(packed_normal & 255u)));
}

ivec2 reliefTexel(int index, int log2_width) {
    return ivec2(index & ((1 << log2_width) - 1), index >> log2_width);
}

// R,G: normal; B,A: 16-bit fixed-point depth, 0 where empty.
bool reliefFixedTexel(int index, float depth_max, out float depth, out vec3 normal) {
    vec4 bytes = floor(texelFetch(u_relief_fixed, reliefTexel(index, u_relief_count.z), 0) * 255.0 + 0.5);
    float code = bytes.b * 256.0 + bytes.a;
    depth = (code - 1.0) * (depth_max / 65534.0);
    normal = reliefNormal(bytes.rg);
    return code > 0.0;
}

void reliefVoteOrthographic(inout ReliefField best, int i, vec3 p, ivec4 place, ivec4 info) {
    bool encloses = reliefHas(info, RELIEF_ENCLOSES);
    vec2 size = vec2(float(place.w), float(info.x));
    vec2 inverse_size = vec2(u_relief_maps[i].column[1].w, u_relief_maps[i].column[2].w);
    vec2 at = p.xy * size;
    bool in_window = at.x >= 1.0 && at.y >= 1.0 && at.x < size.x - 1.0 && at.y < size.y - 1.0;
    bool in_depth = p.z >= 0.0 && p.z <= 1.0;
    if (!in_window || !(in_depth || encloses)) {
        if (encloses) {
            reliefAdd(best, RELIEF_FAR_OUTSIDE, vec3(0.0), i);
        }
        return;
    }
    int texel = place.x + int(at.y) * place.y + int(at.x);

    // One texel holds one surface or, front-back, two: the nearer in front, the farther in back.
    bool plane = reliefIsPlane(info);
    // From the ray of the texel's centre.
    vec3 from = reliefFromMap(i, vec3((at - (floor(at) + 0.5)) * inverse_size, p.z));
    vec3 ray = u_relief_maps[i].column[2].xyz;
    float standing = u_relief_maps[i].object_per_map.w;
    float scale = u_relief_maps[i].object_per_map.z;
    bool found;
    float depth;
    vec3 normal;
    float vote;
    if (reliefIsFrontBack(info)) {
        uvec4 words = texelFetch(u_relief_front_back, reliefTexel(texel, u_relief_count.w), 0);
        found = words.b != 0u || words.a != 0u;
        float front = reliefFrontBackDepth(info.y, words.b);
        float back = reliefFrontBackDepth(info.y, words.a);
        vec3 back_normal = vec3(0.0);
        if (plane) {
            normal = reliefPackedNormal(words.r);
            back_normal = reliefPackedNormal(words.g);
            front = reliefPlane(i, normal, front, 1.0, from, ray, standing);
            back = reliefPlane(i, back_normal, back, 1.0, from, ray, standing);
        } else {
            front = scale * (front - p.z);
            back = scale * (p.z - back);
        }
        front = words.b != 0u ? front : RELIEF_FAR_INSIDE;
        back = words.a != 0u ? back : RELIEF_FAR_INSIDE;
        bool take_back = reliefReplaces(back, front);
        vote = take_back ? back : front;
        if (plane) {
            normal = take_back ? back_normal : normal;
        } else {  // only the normal that is needed
            normal = reliefPackedNormal(take_back ? words.g : words.r);
        }
    } else {
        if (reliefIsFloat(info)) {
            vec4 values = texelFetch(u_relief_float, reliefTexel(texel, u_relief_count.y), 0);
            normal = values.rgb;
            depth = values.a;
            found = depth >= 0.0;
        } else {
            found = reliefFixedTexel(texel, 1.0, depth, normal);
        }
        if (plane) {
            vote = reliefPlane(i, normal, depth, 1.0, from, ray, standing);
        } else {
            vote = scale * ((info.z & RELIEF_KEEPS_FARTHEST) != 0 ? p.z - depth : depth - p.z);
        }
    }
    if (!found) {
        if (reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE)) {
            reliefAdd(best, RELIEF_FAR_OUTSIDE, vec3(0.0), i);
        }
        return;
    }
    if (!in_depth && !(vote >= 0.0)) {  // past the far end of the volume nothing of the collider remains
        vote = RELIEF_FAR_OUTSIDE;
        normal = vec3(0.0);
    }
    reliefAdd(best, vote, normal, i);
}

void reliefVoteCube(inout ReliefField best, int i, vec3 p, ivec4 place, ivec4 info) {
    bool in_volume = all(lessThanEqual(abs(p), vec3(1.0)));
    if (!in_volume && !reliefHas(info, RELIEF_ENCLOSES)) {
        return;
    }
    if (!all(lessThanEqual(abs(p), vec3(1e15)))) {  // the squares below must not overflow
        reliefAdd(best, RELIEF_FAR_OUTSIDE, vec3(0.0), i);
        return;
    }
    float radius = reliefLength(p);
    vec3 direction = radius > 0.0 ? p / radius : vec3(1.0, 0.0, 0.0);
    vec3 st_face = reliefCubeCoordinates(direction);
    ivec2 at = min(ivec2(st_face.xy * float(place.w)), ivec2(place.w - 1));
    float depth;
    vec3 normal;
    int texel = place.x + int(st_face.z) * place.z + at.y * place.y + at.x;
    if (!reliefFixedTexel(texel, RELIEF_CUBE_DEPTH_MAX, depth, normal)) {
        if (reliefHas(info, RELIEF_EMPTY_IS_OUTSIDE)) {
            reliefAdd(best, RELIEF_FAR_OUTSIDE, vec3(0.0), i);
        }
        return;
    }
    float vote;
    if (reliefIsPlane(info)) {
        vec3 center = reliefCubeDirection(vec3((vec2(at) + 0.5) / float(place.w), st_face.z));
        vec3 ray = center / reliefLength(center);
        float standing = RELIEF_STANDING_COSINE * reliefLength(u_relief_maps[i].object_per_map.xyz * ray);
        vote = reliefPlane(i, normal, depth, RELIEF_CUBE_DEPTH_MAX, reliefFromMap(i, p), reliefFromMap(i, ray), standing);
    } else {
        float ahead = (info.z & RELIEF_KEEPS_FARTHEST) != 0 ? radius - depth : depth - radius;
        vote = ahead * reliefLength(u_relief_maps[i].object_per_map.xyz * direction);
    }
    if (!in_volume && !(vote >= 0.0)) {
        vote = RELIEF_FAR_OUTSIDE;
        normal = vec3(0.0);
    }
    reliefAdd(best, vote, normal, i);
}

void reliefVote(inout ReliefField best, int i, vec3 p) {
    vec4 row0 = u_relief_maps[i].row[0];
    vec4 row1 = u_relief_maps[i].row[1];
    vec4 row2 = u_relief_maps[i].row[2];
    vec3 in_map = vec3(reliefRow(row0, p), reliefRow(row1, p), reliefRow(row2, p));
    ivec4 place = u_relief_maps[i].place;
    ivec4 info = u_relief_maps[i].info;
    if (reliefIsCube(info)) {
        reliefVoteCube(best, i, in_map, place, info);
    } else {
        reliefVoteOrthographic(best, i, in_map, place, info);
    }
}

// The maps [first, end) alone, as reliefSolid or, with `whole`, reliefEvaluate.
ReliefField reliefMaps(int first, int end, vec3 p, bool whole) {
    ReliefField best = ReliefField(RELIEF_FAR_INSIDE, vec3(0.0), -1);
    for (int i = first; i < end && (whole || best.distance < 0.0); ++i) {
        reliefVote(best, i, p);
    }
    return best;
}

// From p to the nearest point of what map i looks at; zero where p is in it. Beyond an edge of the volume, where no
// map may see anything, it is the way to what lies nearest there.
vec3 reliefToVolume(int i, vec3 p) {
    vec3 in_map = vec3(reliefRow(u_relief_maps[i].row[0], p), reliefRow(u_relief_maps[i].row[1], p),
                       reliefRow(u_relief_maps[i].row[2], p));
    vec3 low = vec3(-1.0);
    vec3 high = vec3(1.0);
    if (!reliefIsCube(u_relief_maps[i].info)) {  // its rim has nothing
        low = vec3(u_relief_maps[i].column[1].w, u_relief_maps[i].column[2].w, 0.0);
        high = 1.0 - low;
    }
    return reliefFromMap(i, clamp(in_map, low, high) - in_map);
}

// Where a ball touches whose centre is outside: each map that sees a surface near says which way it lies, and the
// point of the ball there is asked for. The deepest such point decides, with a distance below 0; else the result is
// RELIEF_FAR_OUTSIDE.
ReliefField reliefTouch(int first, int end, vec3 center, float radius) {
    ReliefField best = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    for (int i = first; i < end; ++i) {
        ReliefField near = ReliefField(RELIEF_FAR_INSIDE, vec3(0.0), -1);
        reliefVote(near, i, center);
        // A projected distance may be some times the distance.
        bool seen = near.distance >= 0.0 && near.distance < 4.0 * radius;
        vec3 way = reliefToVolume(i, center);
        float apart = reliefLength(way);
        if (seen || (apart > 0.0 && apart < radius)) {
            vec3 normal = seen ? near.normal : -way / apart;
            ReliefField touched = reliefMaps(first, end, center - radius * normal, false);
            if (reliefInside(touched) && touched.distance < best.distance) {
                best = ReliefField(touched.distance, seen ? touched.normal : normal, touched.map);
            }
        }
    }
    return best;
}

#if RELIEF_BODIES == 0

// Of all maps, in the object space that they share.
ReliefField reliefEvaluate(vec3 p) {
    return reliefMaps(0, u_relief_count.x, p, true);
}

#define RELIEF_VOTE_OF(n) \
    if (n < RELIEF_MAP_CAPACITY && best.distance < 0.0) { \
        reliefVote(best, min(n, RELIEF_MAP_CAPACITY - 1), p); \
    }

// What a step of a simulation needs: the same as reliefEvaluate where P is inside; where it is not, the first map
// that sees it outside ends the walk, so that most points cost one fetch however many maps there are. (Rule 2
// never turns a vote ≥ 0 into one below.) The first maps are named by constants, so that GPUs need not index the
// block for them.
ReliefField reliefSolid(vec3 p) {
    ReliefField best = ReliefField(RELIEF_FAR_INSIDE, vec3(0.0), -1);
    RELIEF_VOTE_OF(0)
    RELIEF_VOTE_OF(1)
    RELIEF_VOTE_OF(2)
    RELIEF_VOTE_OF(3)
    RELIEF_VOTE_OF(4)
    RELIEF_VOTE_OF(5)
    RELIEF_VOTE_OF(6)
    RELIEF_VOTE_OF(7)
    for (int i = 8; i < u_relief_count.x && best.distance < 0.0; ++i) {
        reliefVote(best, i, p);
    }
    return best;
}

// reliefInside(reliefSolid(p)), by asking map `first` before the others, if it is one: the map that decides what is
// inside nearby knows most often that p is outside.
bool reliefSolidAt(vec3 p, int first) {
    ReliefField best = ReliefField(RELIEF_FAR_INSIDE, vec3(0.0), -1);
    if (first >= 0) {
        reliefVote(best, first, p);
    }
    for (int i = 0; i < u_relief_count.x && best.distance < 0.0; ++i) {
        reliefVote(best, i, p);
    }
    return reliefInside(best);
}

#else

vec3 reliefToObject(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
    return vec3(reliefRow(row0, p), reliefRow(row1, p), reliefRow(row2, p));
}

// Where a point of a body's object space lies in the world. (The transposed of a rotation is its inverse.)
vec3 reliefToWorld(vec4 row0, vec4 row1, vec4 row2, float scale, vec3 q) {
    return (scale * scale) * (row0.xyz * (q.x - row0.w) + (row1.xyz * (q.y - row1.w) + row2.xyz * (q.z - row2.w)));
}

// World to object space and back, at the beginning and at the end of the step.
vec3 reliefBodyNow(int body, vec3 p) {
    return reliefToObject(u_relief_bodies[body].row[0], u_relief_bodies[body].row[1], u_relief_bodies[body].row[2], p);
}
vec3 reliefBodyBefore(int body, vec3 p) {
    return reliefToObject(u_relief_bodies[body].before[0], u_relief_bodies[body].before[1],
                          u_relief_bodies[body].before[2], p);
}
vec3 reliefWorldNow(int body, vec3 q) {
    return reliefToWorld(u_relief_bodies[body].row[0], u_relief_bodies[body].row[1], u_relief_bodies[body].row[2],
                         u_relief_bodies[body].response.x, q);
}
vec3 reliefWorldBefore(int body, vec3 q) {
    return reliefToWorld(u_relief_bodies[body].before[0], u_relief_bodies[body].before[1],
                         u_relief_bodies[body].before[2], u_relief_bodies[body].response.x, q);
}

vec3 reliefWorldNormal(int body, vec3 n) {
    return u_relief_bodies[body].response.x *
           (u_relief_bodies[body].row[0].xyz * n.x +
            (u_relief_bodies[body].row[1].xyz * n.y + u_relief_bodies[body].row[2].xyz * n.z));
}

// What one body says of a ball about a point of its object space, as reliefSolid or, with `whole`, reliefEvaluate.
ReliefField reliefBodyField(int body, vec3 q, float radius, bool whole) {
    int first = u_relief_bodies[body].maps.x;
    int end = first + u_relief_bodies[body].maps.y;
    ReliefField best = reliefMaps(first, end, q, whole);
#if defined(RELIEF_RADIUS)
    if (radius > 0.0 && !reliefInside(best)) {
        return reliefTouch(first, end, q, radius / u_relief_bodies[body].response.x);
    }
#endif
    return best;
}

// The union of all bodies in the world, which the nearest, inside the deepest, decides. The distance is in world
// units. body is -1 where none has a say.
ReliefField reliefUnion(vec3 p, float radius, bool whole, out int body) {
    ReliefField best = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    body = -1;
    for (int b = 0; b < RELIEF_BODIES; ++b) {
        float scale = u_relief_bodies[b].response.x;
        ReliefField field = reliefBodyField(b, reliefBodyNow(b, p), radius, whole);
        if (field.map >= 0 && scale * field.distance < best.distance) {
            best = ReliefField(scale * field.distance, reliefWorldNormal(b, field.normal), field.map);
            body = b;
        }
    }
    return best;
}

ReliefField reliefSolid(vec3 p) {
    int body;
    return reliefUnion(p, 0.0, false, body);
}

ReliefField reliefEvaluate(vec3 p) {
    int body;
    return reliefUnion(p, 0.0, true, body);
}

#if RELIEF_LIVE

// The way that the surface of map i at a point p of object space has gone since the update before, in object units. Of
// two ends it is the one whose normal is more like `normal`. Zero where the map has no surface.
vec3 reliefMotion(int i, vec3 p, vec3 normal) {
    vec3 in_map = vec3(reliefRow(u_relief_maps[i].row[0], p), reliefRow(u_relief_maps[i].row[1], p),
                       reliefRow(u_relief_maps[i].row[2], p));
    ivec4 place = u_relief_maps[i].place;
    ivec4 info = u_relief_maps[i].info;
    ivec2 at;
    if (reliefIsCube(info)) {
        float radius = reliefLength(in_map);
        vec3 st_face = reliefCubeCoordinates(radius > 0.0 ? in_map / radius : vec3(1.0, 0.0, 0.0));
        at = min(ivec2(st_face.xy * float(place.w)), ivec2(place.w - 1));
        at.y += int(st_face.z) * place.w;
    } else {
        at = ivec2(clamp(in_map.xy * vec2(float(place.w), float(info.x)), vec2(0.0), vec2(place.w - 1, info.x - 1)));
        if (reliefIsFrontBack(info)) {
            uvec4 words = texelFetch(u_relief_front_back,
                                     reliefTexel(place.x + at.y * place.y + at.x, u_relief_count.w), 0);
            float front = reliefDot(normal, reliefPackedNormal(words.r));
            float back = reliefDot(normal, reliefPackedNormal(words.g));
            at.y += words.b == 0u || (words.a != 0u && back > front) ? info.x : 0;
        }
    }
    int texel = info.w + (at.y << u_relief_count.y) + at.x;
    return texelFetch(u_relief_float, reliefTexel(texel, u_relief_count.y), 0).xyz;
}

// The same of a body; zero of one that is not live. q: object space at the end of the step; normal: in the world.
vec3 reliefBodyMotion(int body, int map, vec3 q, vec3 normal) {
    if (u_relief_bodies[body].maps.z == 0 || map < 0) {
        return vec3(0.0);
    }
    vec3 in_body = u_relief_bodies[body].response.x *
                   reliefToObject(vec4(u_relief_bodies[body].row[0].xyz, 0.0), vec4(u_relief_bodies[body].row[1].xyz, 0.0),
                                  vec4(u_relief_bodies[body].row[2].xyz, 0.0), normal);
    return reliefMotion(map, q, in_body);
}

// What rests on a live body goes with the surface that is nearest. Of each map alone: where one sees nothing near a
// silhouette, another one does.
vec3 reliefNearestMotion(int body, vec3 q) {
    ReliefField nearest = ReliefField(RELIEF_FAR_OUTSIDE, vec3(0.0), -1);
    int first = u_relief_bodies[body].maps.x;
    for (int i = first; i < first + u_relief_bodies[body].maps.y; ++i) {
        ReliefField one = ReliefField(RELIEF_FAR_INSIDE, vec3(0.0), -1);
        reliefVote(one, i, q);
        if (one.map >= 0 && abs(one.distance) < abs(nearest.distance)) {
            nearest = one;
        }
    }
    return nearest.map >= 0 ? reliefMotion(nearest.map, q, nearest.normal) : vec3(0.0);
}

#endif

#endif
