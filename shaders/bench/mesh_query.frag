// SPDX-License-Identifier: Apache-2.0
// Queries mesh_tree.glsl at the points of a texture, for its test.
//!include bench/mesh_tree.glsl

uniform highp sampler2D u_points;
layout(location = 0) out vec4 o_field;  // normal and signed distance

void main() {
    vec3 p = texelFetch(u_points, ivec2(gl_FragCoord.xy), 0).xyz;
    vec3 normal;
    float distance = meshDistance(closestPoint(p, RELIEF_UNBOUNDED), normal);
    o_field = vec4(normal, distance);
}
