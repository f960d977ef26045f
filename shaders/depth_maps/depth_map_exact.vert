// As depth_map.vert, but for coverage that does not depend on the rasteriser's grid: every triangle is drawn a
// little larger, and depth_map.frag leaves out the texels whose centres it does not hold.
//
//             + k above c          base: the longest edge. With H = h + k at least a texel, and
//            /.\                   k and m at least sqrt(reach H), every point of the triangle is
//           / c \                  `reach` away from all three sides of the larger one.
//          / / \ \  h
//         / a---b \
//        +---------+ m beyond a and b, reach below them
//
// Attributes: none. Vertex 3 i + j is corner j of triangle i.
uniform highp sampler2D u_positions;
uniform highp usampler2D u_corners;
uniform highp usampler2D u_planes;
uniform ivec2 u_shift;
uniform vec3 u_center;
uniform vec4 u_row[3];
uniform mat3 u_object;
uniform vec2 u_window;
uniform vec3 u_residual;
uniform float u_reach;  // texels: more than the rasteriser moves a vertex

flat out vec4 v_at;
flat out vec2 v_slope;
flat out uvec2 v_triangle;
flat out vec3 v_a;  // corners in clip space: x, y, w
flat out vec3 v_b;
flat out vec3 v_c;

vec3 corner(uint vertex) {
    int i = int(vertex);
    return texelFetch(u_positions, ivec2(i & ((1 << u_shift.x) - 1), i >> u_shift.x), 0).xyz - u_center;
}

vec3 inRows(vec3 p) {
    return vec3(dot(u_row[0].xyz, p) + u_row[0].w, dot(u_row[1].xyz, p) + u_row[1].w,
                dot(u_row[2].xyz, p) + u_row[2].w);
}

bool outside(vec3 x, vec3 w) {
    return all(greaterThan(x, w)) || all(lessThan(x, -w));
}

// Corner j of the larger triangle, in texels of the window.
vec2 larger(vec2 a, vec2 b, vec2 c, int j) {
    vec3 length2 = vec3(dot(c - b, c - b), dot(a - c, a - c), dot(b - a, b - a));
    if (length2.x > length2.z && length2.x >= length2.y) {
        vec2 t = a;
        a = b;
        b = c;
        c = t;
    } else if (length2.y > length2.z) {
        vec2 t = a;
        a = c;
        c = b;
        b = t;
    }
    float base = length(b - a);
    vec2 along = base > 0.0 ? (b - a) / base : vec2(1.0, 0.0);
    vec2 up = vec2(-along.y, along.x);
    float height = dot(c - a, up);
    if (height < 0.0) {
        height = -height;
        up = -up;
    }
    float k = max(0.0, 1.0 - height) + sqrt(u_reach * (height + 1.0)) + 2.0 * u_reach;
    float h = height + k;
    float m = u_reach * (3.0 * base / h + 2.0) + sqrt(u_reach * h);
    return j == 0   ? a - m * along - u_reach * up
           : j == 1 ? b + m * along - u_reach * up
                    : a + dot(c - a, along) * along + h * up;
}

void main() {
    int triangle = gl_VertexID / 3;
    int j = gl_VertexID - 3 * triangle;
    ivec2 texel = ivec2(triangle & ((1 << u_shift.y) - 1), triangle >> u_shift.y);
    uvec3 corners = texelFetch(u_corners, texel, 0).xyz;
    uvec4 plane = texelFetch(u_planes, texel, 0);
    vec3 n = uintBitsToFloat(plane.xyz);
    vec3 p = corner(corners.z);
    vec3 a = inRows(corner(corners.x));
    vec3 b = inRows(corner(corners.y));
    vec3 c = inRows(p);
    v_triangle = uvec2(uint(triangle), plane.w);
#ifdef RELIEF_CUBE
    v_at = vec4(n, 0.0);
    v_slope = vec2(dot(n, p + u_residual), 0.0);
    v_a = a;
    v_b = b;
    v_c = c;
#else
    vec3 m = n * u_object;
    v_at = vec4(c, m.z / length(u_object[2]));
    v_slope = -m.xy / m.z;
    v_a = vec3(2.0 * a.xy / u_window - 1.0, 1.0);
    v_b = vec3(2.0 * b.xy / u_window - 1.0, 1.0);
    v_c = vec3(2.0 * c.xy / u_window - 1.0, 1.0);
#endif
    vec3 x = vec3(v_a.x, v_b.x, v_c.x);
    vec3 y = vec3(v_a.y, v_b.y, v_c.y);
    vec3 w = vec3(v_a.z, v_b.z, v_c.z);
    // The larger triangle reaches no texel's centre outside of the window either: by a texel at least.
    vec3 wide = w * (1.0 + 4.0 / min(u_window.x, u_window.y));
    if (all(lessThanEqual(w, vec3(0.0))) || outside(x, wide) || outside(y, wide)) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        return;
    }
    vec2 at;
    if (min(w.x, min(w.y, w.z)) > 1e-3 * max(w.x, max(w.y, w.z))) {
        vec2 half_window = 0.5 * u_window;
        at = larger((v_a.xy / v_a.z + 1.0) * half_window, (v_b.xy / v_b.z + 1.0) * half_window,
                    (v_c.xy / v_c.z + 1.0) * half_window, j) / half_window - 1.0;
    } else {
        // Next to a cube's centre, and partly behind its face: left to the fragments.
        at = vec2(j == 1 ? 3.0 : -1.0, j == 2 ? 3.0 : -1.0);
    }
    gl_Position = vec4(at, 0.0, 1.0);
}
