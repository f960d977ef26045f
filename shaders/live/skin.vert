// SPDX-License-Identifier: Apache-2.0
// Poses the vertices of an animated mesh, for transform feedback; nothing is rasterised. formats/animation/mesh_pose.h
// is the reference.
layout(location = 0) in vec3 a_position;  // before joints and targets move it
layout(location = 1) in uvec4 a_lists;    // ranges of its influences and of its deltas: first, and one past the last
#if defined(RELIEF_NORMALS)
layout(location = 2) in vec3 a_normal;  // unit length, or zero
#endif

uniform highp sampler2D u_pose;         // three rows per joint, then the weight of each target in x
uniform highp usampler2D u_influences;  // joint, bits of its weight
uniform highp sampler2D u_deltas;       // xyz; the target in w
uniform highp ivec3 u_shifts;           // log2 of the widths of these textures
uniform int u_joints;
uniform vec3 u_origin;  // subtracted from the output, object space

out vec3 v_position;
#if defined(RELIEF_NORMALS)
out vec3 v_normal;
#endif

ivec2 placeOf(uint i, int shift) {
    return ivec2(int(i & ((1u << uint(shift)) - 1u)), int(i >> uint(shift)));
}

vec4 poseAt(int i) {
    return texelFetch(u_pose, placeOf(uint(i), u_shifts.x), 0);
}

void main() {
    vec3 position = a_position;
    for (uint i = a_lists.z; i < a_lists.w; ++i) {
        vec4 delta = texelFetch(u_deltas, placeOf(i, u_shifts.z), 0);
        position += poseAt(3 * u_joints + int(delta.w)).x * delta.xyz;
    }
    vec3 sum = vec3(0.0);
#if defined(RELIEF_NORMALS)
    vec3 normal = vec3(0.0);
#endif
    for (uint i = a_lists.x; i < a_lists.y; ++i) {
        uvec2 influence = texelFetch(u_influences, placeOf(i, u_shifts.y), 0).xy;
        float weight = uintBitsToFloat(influence.y);
        int joint = 3 * int(influence.x);
        vec4 x = poseAt(joint);
        vec4 y = poseAt(joint + 1);
        vec4 z = poseAt(joint + 2);
        sum += weight * (vec3(dot(x.xyz, position), dot(y.xyz, position), dot(z.xyz, position)) + vec3(x.w, y.w, z.w));
#if defined(RELIEF_NORMALS)
        normal += weight * vec3(dot(x.xyz, a_normal), dot(y.xyz, a_normal), dot(z.xyz, a_normal));
#endif
    }
    v_position = sum - u_origin;
#if defined(RELIEF_NORMALS)
    float size = length(normal);
    v_normal = size > 0.0 ? normal / size : a_normal;
#endif
    gl_Position = vec4(0.0);
}
