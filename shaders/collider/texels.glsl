// SPDX-License-Identifier: Apache-2.0
// For collider.glsl: decoding of normals and depths, and transforms between the spaces of a map.

// Equation 3 in index steps, so that it is exact. shaderTexels() removes index 255.
vec3 reliefOctahedron(vec2 index) {
    return reliefFold(index, float(RELIEF_NORMAL_HALF_RANGE));
}

vec3 reliefOctahedron(uint code) {
    return reliefOctahedron(vec2(float(code >> 8), float(code & 255u)));
}

// Transforms a point from object space to the space of map i.
vec3 reliefInMap(int i, vec3 p) {
    return vec3(reliefRow(reliefMapRow(i, 0), p), reliefRow(reliefMapRow(i, 1), p),
                reliefRow(reliefMapRow(i, 2), p));
}

// Returns true if p, in map space, lies above the texels of an orthographic map, excluding the empty border.
bool reliefInWindow(int i, vec3 p) {
    return p.x >= 1.0 && p.y >= 1.0 && p.x < reliefMapColumn(i, 1).w && p.y < reliefMapColumn(i, 2).w;
}

bool reliefInDepth(vec3 p) {
    return p.z >= 0.0 && p.z <= 1.0;
}

float reliefLength(vec3 v) {
    return sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
}

// Returns the face that d hits and the position on it by OpenGL's rule; ties are resolved in the order x, y, z.
// Computed manually on six layers, so that every GL selects the same texel as the CPU and no seam is filtered.
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

// Returns the direction through (s, t) of a face; its largest component is 1.
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

// Transforms directions from map space to object space.
vec3 reliefFromMap(int i, vec3 q) {
    return reliefMapColumn(i, 0).xyz * q.x +
           (reliefMapColumn(i, 1).xyz * q.y + reliefMapColumn(i, 2).xyz * q.z);
}

// Returns the vote of a plane: n*(P - S). along_normal: n times 1 / per_length; from: P - O, where O is the point at
// depth 0 on the ray of the texel's centre; ray: its direction per unit of depth.
float reliefPlane(vec3 along_normal, float per_length, float depth, vec3 from, vec3 ray) {
    float along = per_length * reliefDot(along_normal, ray);
    return per_length * reliefDot(along_normal, from) - depth * along;
}

float reliefOctahedralPlane(vec3 along_normal, float depth, vec3 from, vec3 ray) {
    return reliefPlane(along_normal, inversesqrt(reliefDot(along_normal, along_normal)), depth, from, ray);
}

// Decodes a positive normal half-float depth by changing the exponent's bias from 15 to 127. GLSL 3.30 has no
// unpackHalf2x16.
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

// R,G: indices of the normal; B,A: 16-bit fixed-point depth, 0 if empty.
bool reliefFixedTexel(int index, float depth_max, out float depth, out vec2 normal) {
    vec4 bytes = floor(texelFetch(u_relief_fixed, reliefTexel(index, RELIEF_LOG2_WIDTHS.y), 0) * 255.0 + 0.5);
    float code = bytes.b * 256.0 + bytes.a;
    depth = (code - 1.0) * (depth_max / float(RELIEF_DEPTH_STEPS));
    normal = bytes.rg;
    return code > 0.0;
}

// A normal in texel form: only the normal of the deciding vote is decoded. Patches compute normals from their heights.
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
