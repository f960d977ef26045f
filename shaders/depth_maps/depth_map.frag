// SPDX-License-Identifier: Apache-2.0
// Computes one texel of a front-back map: the plane of the rasterised triangle at the texel's centre in container form
// (formats/README.md), and its motion. Each is written to the channels of both surfaces; the colour mask selects one.
//!include depth_maps/normal_index.glsl
uniform highp sampler2D u_positions;
uniform highp usampler2D u_corners;
uniform ivec2 u_shift;
uniform vec3 u_center;
uniform vec4 u_row[3];
uniform bool u_far;          // render the far surface: rays run against the depth
uniform bool u_starts_free;  // otherwise inner sides leave the texel empty
uniform vec3 u_ray;          // object units per unit of depth

flat in vec4 v_at;
flat in vec2 v_slope;
flat in uvec2 v_triangle;
in vec3 v_motion;

layout(location = 0) out uvec4 o_texel;
layout(location = 1) out vec4 o_motion_xy;
layout(location = 2) out vec4 o_motion_z;

const float kSteps = float(RELIEF_DEPTH_STEPS);

float cornerDepth(uint vertex) {
    int i = int(vertex);
    vec3 position = texelFetch(u_positions, ivec2(i & ((1 << u_shift.x) - 1), i >> u_shift.x), 0).xyz - u_center;
    return dot(u_row[2].xyz, position) + u_row[2].w;
}

// The plane of a triangle seen almost edge-on extrapolates poorly, so clamp to the range of its corners.
float insideTriangle(float depth) {
    int i = int(v_triangle.x);
    uvec3 corners = texelFetch(u_corners, ivec2(i & ((1 << u_shift.y) - 1), i >> u_shift.y), 0).xyz;
    vec3 at = vec3(cornerDepth(corners.x), cornerDepth(corners.y), cornerDepth(corners.z));
    float low = min(at.x, min(at.y, at.z));
    float high = max(at.x, max(at.y, at.z));
    return depth >= low && depth <= high ? depth : depth > high ? high : low;
}

// Returns the packed normal and depth code of the plane through the surface point on the centre's ray
// (bake/named_maps/plane_fit.cpp with one ray per texel). The depth is rounded towards the viewer. A plane too steep to
// be stored is replaced by a plane that faces the viewer.
uvec2 stored(uint normal, float depth) {
    float u = u_far ? 1.0 - depth : depth;  // from the start of the ray
    vec3 onwards = normalize(u_far ? -u_ray : u_ray);
    float from_start = clamp(floor(u * kSteps), 0.0, kSteps);
    bool steep = dot(reliefUnpackNormal(normal), onwards) > -RELIEF_PLANE_COSINE_MIN;
    return uvec2(steep ? reliefPackNormal(-onwards) : normal, 1u + uint(u_far ? kSteps - from_start : from_start));
}

void main() {
    float cosine = v_at.w;
    float depth = v_at.z + dot(v_slope, gl_FragCoord.xy - v_at.xy);
    if (!(abs(cosine) > RELIEF_GRAZING_COSINE)) {
        depth = insideTriangle(depth);
    }
    bool behind = u_far ? cosine < 0.0 : cosine > 0.0;
    o_texel = uvec4(0u);
    vec3 motion = vec3(0.0);
    if (u_starts_free || !behind) {  // otherwise the ray started inside: the space before this surface is not free
        uint normal = behind ? v_triangle.y >> 16 : v_triangle.y & 0xffffu;
        o_texel = stored(normal, clamp(depth, 0.0, 1.0)).xxyy;
        motion = v_motion;
    }
    o_motion_xy = motion.xxyy;
    o_motion_z = motion.zzzz;
}
