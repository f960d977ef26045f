// SPDX-License-Identifier: Apache-2.0
// Renders a mesh into a depth map: slots from GpuMesh (runtime/depth_maps/gpu_mesh.h), frame from DepthMapRenderer. The
// flat outputs come from the provoking corner, which identifies the triangle.
layout(location = 0) in uint a_vertex;

uniform highp sampler2D u_positions;
uniform highp sampler2D u_previous;
uniform highp usampler2D u_planes;
uniform ivec2 u_shift;  // for vertices, for triangles
uniform vec3 u_center;  // object space; positions are relative to it, for best float precision
uniform vec4 u_row[3];  // object space to texels and depth
uniform mat3 u_object;  // object-space vectors of a texel to the right, a texel up, and a unit of depth
uniform vec2 u_size;    // texels of the map

flat out vec4 v_at;         // a point of the plane, in texels and depth; w: cosine with the ray
flat out vec2 v_slope;      // depth per texel
flat out uvec2 v_triangle;  // x: index, y: packed normals of both sides
out vec3 v_motion;

void main() {
    int vertex = int(a_vertex);
    ivec2 texel = ivec2(vertex & ((1 << u_shift.x) - 1), vertex >> u_shift.x);
    vec3 position = texelFetch(u_positions, texel, 0).xyz;
    v_motion = position - texelFetch(u_previous, texel, 0).xyz;
    // Slots after those of the triangles never provoke, and may read any texel.
    ivec2 own = ivec2(gl_VertexID & ((1 << u_shift.y) - 1), gl_VertexID >> u_shift.y);
    own.y = min(own.y, textureSize(u_planes, 0).y - 1);
    uvec4 plane = texelFetch(u_planes, own, 0);
    vec3 p = position - u_center;
    vec3 q = vec3(dot(u_row[0].xyz, p) + u_row[0].w, dot(u_row[1].xyz, p) + u_row[1].w,
                  dot(u_row[2].xyz, p) + u_row[2].w);
    vec3 m = uintBitsToFloat(plane.xyz) * u_object;
    v_triangle = uvec2(uint(gl_VertexID), plane.w);
    v_at = vec4(q, m.z / length(u_object[2]));
    v_slope = -m.xy / m.z;
    // Also draws RELIEF_DEPTH_SLACK of the depth range outside it.
    gl_Position = vec4(2.0 * q.xy / u_size - 1.0, (2.0 * q.z - 1.0) / (1.0 + 2.0 * RELIEF_DEPTH_SLACK), 1.0);
}
