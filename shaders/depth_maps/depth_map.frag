// One texel of a depth map: of the triangle that the rasteriser found, the depth of its plane at the texel's
// centre and its normal, as the container stores them (formats/README.md).
//
// DepthMapRenderer compiles variants, each in one place below:
//
//     texel        RELIEF_FLOAT, RELIEF_BYTES or RELIEF_WORDS, with RELIEF_HALF or without
//     decode       RELIEF_PLANE or projected
//     projection   RELIEF_CUBE, with RELIEF_BOUNDED where its volume does not hold the mesh, or orthographic
//     motion       RELIEF_MOTION or none
//!include depth_maps/normal_index.glsl
uniform highp sampler2D u_positions;
uniform highp usampler2D u_corners;
uniform highp usampler2D u_planes;
uniform ivec2 u_shift;
uniform vec3 u_center;
uniform vec4 u_row[3];
uniform mat3 u_object;  // cube: the face's axes sc, tc, ma in map space
uniform vec2 u_origin;  // of gl_FragCoord: where the face starts
uniform vec3 u_residual;
uniform vec3 u_scale;        // object units for one unit along each map axis
uniform float u_width;       // cube: texels of a face
uniform bool u_far;          // the far end: rays run against the depth
uniform bool u_starts_free;  // otherwise inner sides leave the texel empty
uniform vec3 u_ray;           // orthographic: along growing depth, unit length
uniform float u_range;        // of standing planes, object units

flat in vec4 v_at;
flat in vec2 v_slope;
flat in uvec2 v_triangle;

const float kStandingMargin = 1e-4;

vec3 position(uint vertex) {
    int i = int(vertex);
    return texelFetch(u_positions, ivec2(i & ((1 << u_shift.x) - 1), i >> u_shift.x), 0).xyz - u_center;
}

ivec2 ownTexel() {
    int i = int(v_triangle.x);
    return ivec2(i & ((1 << u_shift.y) - 1), i >> u_shift.y);
}

// Projection. texelRay(): the texel's ray, object units for one unit of depth; intersect(): with the plane of the triangle:
// cosine and depth; cornerDepth(): the depth of a corner; outsideVolume(): of a depth.

#ifdef RELIEF_CUBE

const float kDepthMax = RELIEF_CUBE_DEPTH_MAX;

vec2 onFace() {
    return 2.0 * (gl_FragCoord.xy - u_origin) / u_width - 1.0;
}

vec3 texelRay() {
    return u_scale * (u_object * normalize(vec3(onFace(), 1.0)));
}

void intersect(vec3 ray, out float cosine, out float depth) {
    float along = dot(v_at.xyz, ray);
    cosine = along / length(ray);
    depth = v_slope.x / along;
}

float cornerDepth(uint vertex, vec3 ray) {
    return dot(position(vertex) + u_residual, ray) / dot(ray, ray);
}

bool outsideVolume(float depth) {
#ifdef RELIEF_BOUNDED
    float leaves = u_far ? length(vec3(abs(onFace()), 1.0)) * (1.0 + RELIEF_DEPTH_SLACK) : kDepthMax;
    return depth > leaves;
#else
    return false;
#endif
}

#else

const float kDepthMax = 1.0;

vec3 texelRay() {
    return u_ray * u_scale.z;
}

void intersect(vec3 ray, out float cosine, out float depth) {
    cosine = v_at.w;
    depth = v_at.z + dot(v_slope, gl_FragCoord.xy - u_origin - v_at.xy);
}

float cornerDepth(uint vertex, vec3 ray) {
    return dot(u_row[2].xyz, position(vertex)) + u_row[2].w;
}

bool outsideVolume(float depth) {
    return false;  // clipped
}

#endif

// The plane of a triangle seen almost edge-on is a poor guide: no further than its corners.
float insideTriangle(vec3 ray, float depth) {
    uvec3 corners = texelFetch(u_corners, ownTexel(), 0).xyz;
    vec3 at = vec3(cornerDepth(corners.x, ray), cornerDepth(corners.y, ray), cornerDepth(corners.z, ray));
    float low = min(at.x, min(at.y, at.z));
    float high = max(at.x, max(at.y, at.z));
    return depth >= low && depth <= high ? depth : depth > high ? high : low;
}

// Codes of depths.

// 1 … 65535
uint fixedCode(float depth) {
    return 1u + uint(floor(clamp(depth / kDepthMax, 0.0, 1.0) * float(RELIEF_DEPTH_STEPS) + 0.5));
}

// Nearest, ties upwards, as formats/texel.cpp rounds; within the normal halves.
uint halfCode(float depth) {
    uint bits = floatBitsToUint(clamp(depth, 6.103515625e-5, 1.0));
    return ((bits + 0x1000u) >> 13) - (112u << 10);
}

float ofHalf(uint code) {
    return uintBitsToFloat((code + (112u << 10)) << 13);
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

// Decode. stored(): a surface as a texel stores it; floatNormal() and halfDepth(): for those formats.

struct Stored {
    uint normal;
    float depth;
    uint code;    // of depth in fixed point, 1…65535
    bool stands;  // of a plane: along the ray
};

#ifdef RELIEF_PLANE

Stored storedCode(uint normal, uint steps, bool stands) {
    return Stored(normal, float(steps) / float(RELIEF_DEPTH_STEPS), 1u + steps, stands);
}

// The plane through the surface point on the centre's ray as decode=plane stores it (bake/texels/plane_fit.cpp with
// one ray a texel): pushed towards the viewer to the next code; standing where it is steep; facing the viewer
// where neither can be stored.
Stored stored(uint normal, vec3 ray, float depth) {
    float u = u_far ? kDepthMax - depth : depth;  // from where the ray starts
    vec3 onwards = u_far ? -ray : ray;
    float length_ray = length(ray);
    vec3 n = reliefUnpackNormal(normal);
    float along = dot(n, onwards);
    float cosine = along / length_ray;
    float facing_code = clamp(floor(u / kDepthMax * float(RELIEF_DEPTH_STEPS)), 0.0, float(RELIEF_DEPTH_STEPS));
    bool stands = abs(cosine) < RELIEF_STANDING_COSINE - kStandingMargin;
    if (stands) {
        // A plane that leans away must not cut the surfaces behind the one that the ray meets.
        float offset = (along > 0.0 ? kDepthMax : u) * along;
        float from_zero = u_far ? -kDepthMax * along : 0.0;
        float code = ceil(((offset + from_zero) / u_range + 1.0) * 0.5 * float(RELIEF_DEPTH_STEPS));
        float kept = (2.0 * code / float(RELIEF_DEPTH_STEPS) - 1.0) * u_range - from_zero;
        float free = along > 0.0 ? min(u, kept / along) : u - max(0.0, kept / along);
        float facing_free = u - facing_code / float(RELIEF_DEPTH_STEPS) * kDepthMax;
        if (code >= 0.0 && code <= float(RELIEF_DEPTH_STEPS) && free <= max(facing_free, 0.0)) {
            return storedCode(normal, uint(code), true);
        }
    } else if (cosine <= -(RELIEF_STANDING_COSINE + kStandingMargin)) {
        return storedCode(normal, uint(u_far ? float(RELIEF_DEPTH_STEPS) - facing_code : facing_code), false);
    }
    return storedCode(reliefPackNormal(-onwards / length_ray),
                      uint(u_far ? float(RELIEF_DEPTH_STEPS) - facing_code : facing_code), false);
}

vec3 floatNormal(Stored surface, bool behind) {
    return reliefUnpackNormal(surface.normal);
}

uint halfDepth(Stored surface) {
    return outwardHalf(surface.depth, !u_far && !surface.stands);
}

#else

Stored stored(uint normal, vec3 ray, float depth) {
    return Stored(normal, depth, fixedCode(depth), false);
}

vec3 floatNormal(Stored surface, bool behind) {
    vec3 n = uintBitsToFloat(texelFetch(u_planes, ownTexel(), 0).xyz);
    return behind ? -n : n;
}

uint halfDepth(Stored surface) {
    return halfCode(surface.depth);
}

#endif

// Texel.

#if defined(RELIEF_FLOAT)

layout(location = 0) out vec4 o_texel;

void writeTexel(Stored surface, bool behind) {
    vec3 n = floatNormal(surface, behind);
    // No -0; compilers leave out an addition of 0.
    o_texel = vec4(n.x == 0.0 ? 0.0 : n.x, n.y == 0.0 ? 0.0 : n.y, n.z == 0.0 ? 0.0 : n.z, surface.depth);
}

void writeNothing() {
    o_texel = vec4(0.0, 0.0, 0.0, -1.0);
}

#elif defined(RELIEF_WORDS)

layout(location = 0) out uvec4 o_texel;

void writeTexel(Stored surface, bool behind) {
#ifdef RELIEF_HALF
    uint code = halfDepth(surface);
#else
    uint code = surface.code;
#endif
    o_texel = uvec4(surface.normal, surface.normal, code, code);
}

void writeNothing() {
    o_texel = uvec4(0u);
}

#else

layout(location = 0) out vec4 o_texel;

void writeTexel(Stored surface, bool behind) {
    o_texel = vec4(uvec4(surface.normal >> 8, surface.normal & 255u, surface.code >> 8, surface.code & 255u)) / 255.0;
}

void writeNothing() {
    o_texel = vec4(0.0);
}

#endif

// Motion, in all channels that either end may keep.

#ifdef RELIEF_MOTION
in vec3 v_motion;
layout(location = 1) out vec4 o_motion_xy;
layout(location = 2) out vec4 o_motion_z;

void writeMotion(bool any) {
    vec3 motion = any ? v_motion : vec3(0.0);
    o_motion_xy = motion.xxyy;
    o_motion_z = motion.zzzz;
}
#else
void writeMotion(bool any) {
}
#endif

void main() {
    vec3 ray = texelRay();
    float cosine, depth;
    intersect(ray, cosine, depth);
    if (!(abs(cosine) > RELIEF_GRAZING_COSINE)) {
        depth = insideTriangle(ray, depth);
    }
    if (outsideVolume(depth)) {
        discard;
    }
    depth = clamp(depth, 0.0, kDepthMax);
#ifdef RELIEF_CUBE
    gl_FragDepth = depth / kDepthMax;  // otherwise the rasteriser's will do
#endif
    bool behind = u_far ? cosine < 0.0 : cosine > 0.0;
    if (!u_starts_free && behind) {
        // The ray started inside: the space before this surface is not free.
        writeNothing();
        writeMotion(false);
    } else {
        writeTexel(stored(behind ? v_triangle.y >> 16 : v_triangle.y & 0xffffu, ray, depth), behind);
        writeMotion(true);
    }
}
