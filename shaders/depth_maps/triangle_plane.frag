// SPDX-License-Identifier: Apache-2.0
// Computes the plane of one triangle per texel, for GpuMesh::planes(): unit normal and packed indices of both sides.
//!include depth_maps/normal_index.glsl
uniform highp sampler2D u_positions;
uniform highp usampler2D u_corners;
uniform int u_shift;  // of u_positions

layout(location = 0) out uvec4 o_plane;

vec3 corner(uint vertex) {
    int i = int(vertex);
    return texelFetch(u_positions, ivec2(i & ((1 << u_shift) - 1), i >> u_shift), 0).xyz;
}

// Scales by a power of two, without rounding, to a largest component in [1, 2). Products of edges of tiny and huge
// triangles then stay in the range of floats.
vec3 scaled(vec3 v) {
    float largest = max(abs(v.x), max(abs(v.y), abs(v.z)));
    uint exponent = clamp(floatBitsToUint(largest) >> 23, 1u, 253u);
    return v * uintBitsToFloat((254u - exponent) << 23);
}

void main() {
    uvec3 at = texelFetch(u_corners, ivec2(gl_FragCoord.xy), 0).xyz;
    vec3 a = corner(at.x);
    vec3 b = corner(at.y);
    vec3 c = corner(at.z);
    vec3 ab = b - a;
    vec3 bc = c - b;
    vec3 ca = a - c;
    // Use the two shorter edges: the rounding error of the normal grows with their lengths.
    vec3 length2 = vec3(dot(ab, ab), dot(bc, bc), dot(ca, ca));
    vec3 n;
    if (length2.x >= length2.y && length2.x >= length2.z) {
        n = cross(scaled(bc), scaled(ca));
    } else if (length2.y >= length2.z) {
        n = cross(scaled(ca), scaled(ab));
    } else {
        n = cross(scaled(ab), scaled(bc));
    }
    float length_n = sqrt(dot(n, n));
    if (!(length_n > 0.0)) {
        o_plane = uvec4(0u);
        return;
    }
    n /= length_n;
    o_plane = uvec4(floatBitsToUint(n), reliefPackNormal(n) | reliefPackNormal(-n) << 16);
}
