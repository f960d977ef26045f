// A mesh into a depth map: GpuMesh's slots (runtime/depth_maps/gpu_mesh.h), DepthMapRenderer's frame. The flat outputs
// are those of the provoking corner, which is the triangle's own.
layout(location = 0) in uint a_vertex;

uniform highp sampler2D u_positions;
uniform highp usampler2D u_planes;
uniform ivec2 u_shift;    // of vertices, of triangles
uniform vec3 u_center;    // object space; positions count from here, where floats are finest
uniform vec4 u_row[3];    // see below
uniform mat3 u_object;    // orthographic: object vectors of a texel to the right, a texel up, a unit of depth
uniform vec2 u_size;      // texels of the map
uniform vec3 u_residual;  // cube: u_center as the float it is, less the centre

flat out vec4 v_at;     // orthographic: a point of the plane, texels and depth; w: cosine with the ray
flat out vec2 v_slope;  // of depth, a texel; cube: x is the plane's distance from the centre, object units
flat out uvec2 v_triangle;  // x: index, y: packed normals of both sides
#ifdef RELIEF_MOTION
uniform highp sampler2D u_previous;
out vec3 v_motion;
#endif

void main() {
    int vertex = int(a_vertex);
    ivec2 texel = ivec2(vertex & ((1 << u_shift.x) - 1), vertex >> u_shift.x);
    vec3 position = texelFetch(u_positions, texel, 0).xyz;
#ifdef RELIEF_MOTION
    v_motion = position - texelFetch(u_previous, texel, 0).xyz;
#endif
    // Slots behind the triangles' own provoke nothing, and may read any texel.
    ivec2 own = ivec2(gl_VertexID & ((1 << u_shift.y) - 1), gl_VertexID >> u_shift.y);
    own.y = min(own.y, textureSize(u_planes, 0).y - 1);
    uvec4 plane = texelFetch(u_planes, own, 0);
    vec3 n = uintBitsToFloat(plane.xyz);
    vec3 p = position - u_center;
    // Orthographic: texels and depth. Cube: x and y of clip space, and w.
    vec3 q = vec3(dot(u_row[0].xyz, p) + u_row[0].w, dot(u_row[1].xyz, p) + u_row[1].w,
                  dot(u_row[2].xyz, p) + u_row[2].w);
    v_triangle = uvec2(uint(gl_VertexID), plane.w);
#ifdef RELIEF_CUBE
    v_at = vec4(n, 0.0);
    v_slope = vec2(dot(n, p + u_residual), 0.0);
    // No depth of clip space, or surfaces near the centre would lie before its near plane.
    gl_Position = vec4(q.xy, 0.0, q.z);
#else
    vec3 m = n * u_object;
    v_at = vec4(q, m.z / length(u_object[2]));
    v_slope = -m.xy / m.z;
    // RELIEF_DEPTH_SLACK of the depth range outside it is drawn too.
    gl_Position = vec4(2.0 * q.xy / u_size - 1.0, (2.0 * q.z - 1.0) / (1.0 + 2.0 * RELIEF_DEPTH_SLACK), 1.0);
#endif
}
