// One texel of a depth map: of the triangle that the rasteriser found, the depth of its plane at the texel's
// centre and its normal, as the container stores them (formats/README.md).
//
// Defined by DepthMapRenderer: RELIEF_FLOAT, RELIEF_BYTES or RELIEF_WORDS (with RELIEF_HALF or without), the
// texel; RELIEF_CUBE; RELIEF_PLANE, decode; RELIEF_BOUNDED, a cube whose volume does not hold the mesh;
// RELIEF_MOTION; RELIEF_EXACT, for depth_map_exact.vert.
//!include normal_index.glsl
uniform highp sampler2D u_positions;
uniform highp usampler2D u_corners;
uniform highp usampler2D u_planes;
uniform ivec2 u_shift;
uniform vec3 u_center;
uniform vec4 u_row[3];
uniform mat3 u_object;  // cube: the face's axes sc, tc, ma in map space
uniform vec2 u_origin;  // of gl_FragCoord: where the window starts; cube: where the face does
uniform vec3 u_residual;
uniform vec3 u_scale;        // object units for one unit along each map axis
uniform float u_width;       // cube: texels of a face
uniform bool u_far;          // the far end: rays run against the depth
uniform bool u_starts_free;  // otherwise inner sides leave the texel empty
uniform bool u_inside_out;
uniform vec3 u_ray;           // orthographic: along growing depth, unit length
uniform float u_range;        // of standing planes, object units
uniform float u_good_enough;  // see DepthMapFrame
#ifdef RELIEF_EXACT
uniform vec2 u_window;  // texels of the window
uniform vec2 u_corner;  // of gl_FragCoord: where it starts
flat in vec3 v_a;
flat in vec3 v_b;
flat in vec3 v_c;
#endif

flat in vec4 v_at;
flat in vec2 v_slope;
flat in uvec2 v_triangle;

#ifdef RELIEF_WORDS
layout(location = 0) out uvec4 o_texel;
#else
layout(location = 0) out vec4 o_texel;
#endif
#ifdef RELIEF_MOTION
in vec3 v_motion;
layout(location = 1) out vec4 o_motion_xy;
layout(location = 2) out vec4 o_motion_z;
#endif

#ifdef RELIEF_CUBE
const float kDepthMax = 1.7320509;
#else
const float kDepthMax = 1.0;
#endif
const float kCodes = 65534.0;
const float kGrazing = 1e-3;           // as in bake/texels/raycast.cpp
const float kStandingCosine = 1.0 / 32.0;  // formats/depth_map.h
const float kStandingMargin = 1e-4;

// The texel's ray: object units for one unit of depth.
vec3 texelRay() {
#ifdef RELIEF_CUBE
    vec2 st = 2.0 * (gl_FragCoord.xy - u_origin) / u_width - 1.0;
    return u_scale * (u_object * normalize(vec3(st, 1.0)));
#else
    return u_ray * u_scale.z;
#endif
}

float cornerDepth(uint vertex, vec3 ray) {
    int i = int(vertex);
    vec3 p = texelFetch(u_positions, ivec2(i & ((1 << u_shift.x) - 1), i >> u_shift.x), 0).xyz - u_center;
#ifdef RELIEF_CUBE
    return dot(p + u_residual, ray) / dot(ray, ray);
#else
    return dot(u_row[2].xyz, p) + u_row[2].w;
#endif
}

// The plane of a triangle seen almost edge-on says little: no further than its corners.
float insideTriangle(vec3 ray, float depth) {
    int i = int(v_triangle.x);
    uvec3 corners = texelFetch(u_corners, ivec2(i & ((1 << u_shift.y) - 1), i >> u_shift.y), 0).xyz;
    vec3 at = vec3(cornerDepth(corners.x, ray), cornerDepth(corners.y, ray), cornerDepth(corners.z, ray));
    float low = min(at.x, min(at.y, at.z));
    float high = max(at.x, max(at.y, at.z));
    return depth >= low && depth <= high ? depth : depth > high ? high : low;
}

// 1 … 65535
uint fixedCode(float depth) {
    return 1u + uint(floor(clamp(depth / kDepthMax, 0.0, 1.0) * kCodes + 0.5));
}

// Nearest, ties upwards, as formats/texel.cpp rounds; within the normal halves.
uint halfCode(float depth) {
    uint bits = floatBitsToUint(clamp(depth, 6.103515625e-5, 1.0));
    return ((bits + 0x1000u) >> 13) - (112u << 10);
}

float ofHalf(uint code) {
    return uintBitsToFloat((code + (112u << 10)) << 13);
}

// What a texel stores of a surface.
struct Stored {
    uint normal;
    uint code;  // of depth, 0…65534; RELIEF_PLANE alone
    bool stands;
};

#ifdef RELIEF_PLANE
// The plane through the surface point on the centre's ray as decode=plane stores it (bake/texels/plane_fit.cpp with
// one ray a texel): pushed towards the viewer to the next code; standing where it is steep; facing the viewer
// where neither can be stored.
Stored storedPlane(uint normal, vec3 ray, float depth) {
    float u = u_far ? kDepthMax - depth : depth;  // from where the ray starts
    vec3 onwards = u_far ? -ray : ray;
    float length_ray = length(ray);
    vec3 n = reliefUnpackNormal(normal);
    float along = dot(n, onwards);
    float cosine = along / length_ray;
    float facing_code = clamp(floor(u / kDepthMax * kCodes), 0.0, kCodes);
    bool stands = abs(cosine) < kStandingCosine - kStandingMargin;
    if (stands) {
        // One that leans away must not cut what lies behind the surface that the ray meets.
        float offset = (along > 0.0 ? kDepthMax : u) * along;
        float from_zero = u_far ? -kDepthMax * along : 0.0;
        float code = ceil(((offset + from_zero) / u_range + 1.0) * 0.5 * kCodes);
        float stored = (2.0 * code / kCodes - 1.0) * u_range - from_zero;
        float free = along > 0.0 ? min(u, stored / along) : u - max(0.0, stored / along);
        float facing_free = u - facing_code / kCodes * kDepthMax;
        if (code >= 0.0 && code <= kCodes && (free <= u_good_enough || free <= facing_free)) {
            return Stored(normal, uint(code), true);
        }
    } else if (cosine <= -(kStandingCosine + kStandingMargin)) {
        return Stored(normal, uint(u_far ? kCodes - facing_code : facing_code), false);
    }
    return Stored(reliefPackNormal(-onwards / length_ray), uint(u_far ? kCodes - facing_code : facing_code), false);
}

// On the viewer's side of the depth.
uint outwardHalf(float depth, bool outwards_is_less) {
    uint nearest = halfCode(depth);
    float decoded = ofHalf(nearest);
    if (outwards_is_less && decoded > depth) {
        return max(nearest - 1u, halfCode(0.0));
    }
    if (!outwards_is_less && decoded < depth) {
        return min(nearest + 1u, halfCode(1.0));
    }
    return nearest;
}
#endif

#ifdef RELIEF_EXACT
// Whether the triangle's projection holds the texel's centre, its edges included. Corners count from the centre,
// so that a shared edge gives both its triangles the same numbers; the slack is what their products may be
// rounded by: rather both hold it than neither.
bool holdsCentre() {
    vec2 centre = 2.0 * (gl_FragCoord.xy - u_corner) / u_window - 1.0;
    vec2 a = v_a.xy - v_a.z * centre;
    vec2 b = v_b.xy - v_b.z * centre;
    vec2 c = v_c.xy - v_c.z * centre;
    vec3 side = vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
    vec3 slack = 4.8e-7 * vec3(length(c - b), length(a - c), length(b - a));
    float turn = dot(side, vec3(v_a.z, v_b.z, v_c.z));
    return turn >= 0.0 ? all(greaterThanEqual(side, -slack)) : all(lessThanEqual(side, slack));
}
#endif

void writeEmpty() {
#ifdef RELIEF_FLOAT
    o_texel = vec4(0.0, 0.0, 0.0, -1.0);
#elif defined(RELIEF_WORDS)
    o_texel = uvec4(0u);
#else
    o_texel = vec4(0.0);
#endif
#ifdef RELIEF_MOTION
    o_motion_xy = vec4(0.0);
    o_motion_z = vec4(0.0);
#endif
}

void main() {
#ifdef RELIEF_EXACT
    if (!holdsCentre()) {
        discard;
    }
#endif
    vec3 ray = texelRay();
#ifdef RELIEF_CUBE
    float along = dot(v_at.xyz, ray);
    float cosine = along / length(ray);
    float depth = v_slope.x / along;
#else
    float cosine = v_at.w;
    float depth = v_at.z + dot(v_slope, gl_FragCoord.xy - u_origin - v_at.xy);
#endif
    if (!(abs(cosine) > kGrazing)) {
        depth = insideTriangle(ray, depth);
    }
#ifdef RELIEF_BOUNDED
    vec2 st = abs(2.0 * (gl_FragCoord.xy - u_origin) / u_width - 1.0);
    float leaves = u_far ? length(vec3(st, 1.0)) * (1.0 + RELIEF_SLACK) : kDepthMax;
    if (depth > leaves) {
        discard;
    }
#endif
#if defined(RELIEF_EXACT) && !defined(RELIEF_CUBE)
    if (depth < -RELIEF_SLACK || depth > 1.0 + RELIEF_SLACK) {
        discard;  // outside of the volume
    }
#endif
    depth = clamp(depth, 0.0, kDepthMax);
#if defined(RELIEF_CUBE) || defined(RELIEF_EXACT)
    gl_FragDepth = depth / kDepthMax;
#endif
    bool behind = u_far ? cosine < 0.0 : cosine > 0.0;
    if (!u_starts_free && behind != u_inside_out) {
        writeEmpty();  // the ray started inside: what lies before this surface is not free
        return;
    }
    uint normal = behind ? v_triangle.y >> 16 : v_triangle.y & 0xffffu;
#ifdef RELIEF_PLANE
    Stored stored = storedPlane(normal, ray, depth);
    normal = stored.normal;
    depth = float(stored.code) / kCodes;
#endif
#ifdef RELIEF_FLOAT
#ifdef RELIEF_PLANE
    vec3 n = reliefUnpackNormal(normal);
#else
    int i = int(v_triangle.x);
    vec3 n = uintBitsToFloat(texelFetch(u_planes, ivec2(i & ((1 << u_shift.y) - 1), i >> u_shift.y), 0).xyz);
    n = behind ? -n : n;
#endif
    // No -0; compilers leave out an addition of 0.
    o_texel = vec4(n.x == 0.0 ? 0.0 : n.x, n.y == 0.0 ? 0.0 : n.y, n.z == 0.0 ? 0.0 : n.z, depth);
#else
#ifdef RELIEF_PLANE
    uint code = 1u + stored.code;
#else
    uint code = fixedCode(depth);
#endif
#ifdef RELIEF_WORDS
#ifdef RELIEF_HALF
#ifdef RELIEF_PLANE
    code = outwardHalf(depth, !u_far && !stored.stands);
#else
    code = halfCode(depth);
#endif
#endif
    o_texel = uvec4(normal, normal, code, code);
#else
    o_texel = vec4(uvec4(normal >> 8, normal & 255u, code >> 8, code & 255u)) / 255.0;
#endif
#endif
#ifdef RELIEF_MOTION
    o_motion_xy = v_motion.xxyy;
    o_motion_z = v_motion.zzzz;
#endif
}
