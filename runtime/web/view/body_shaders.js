// Shaders that draw a body: what its maps see, its mesh, a slice through it, the floor.
import { kColorsGlsl } from "./colors.js";

export const kBodyVertex = `
in vec3 a_position;
uniform mat4 u_camera;
uniform mat4 u_model;
out vec3 v_object;
out vec3 v_world;
void main() {
    v_object = a_position;
    v_world = (u_model * vec4(a_position, 1.0)).xyz;
    gl_Position = u_camera * vec4(v_world, 1.0);
}`;

// The same of a mesh that deforms: its vertices are in a texture (LiveMesh of relief.d.ts).
export const kLiveVertex = `
precision highp int;
precision highp usampler2D;
uniform highp sampler2D u_positions;
uniform usampler2D u_corners;
uniform int u_vertex_shift;
uniform int u_triangle_shift;
uniform mat4 u_camera;
uniform mat4 u_model;
out vec3 v_object;
out vec3 v_world;
ivec2 at(int i, int shift) { return ivec2(i & ((1 << shift) - 1), i >> shift); }
void main() {
    uvec4 corners = texelFetch(u_corners, at(gl_VertexID / 3, u_triangle_shift), 0);
    v_object = texelFetch(u_positions, at(int(corners[gl_VertexID % 3]), u_vertex_shift), 0).xyz;
    v_world = (u_model * vec4(v_object, 1.0)).xyz;
    gl_Position = u_camera * vec4(v_world, 1.0);
}`;

// Two lights: one from above the eye's left, one from behind. normal: in the world.
const kShade = `
in vec3 v_object;
in vec3 v_world;
uniform mat4 u_model;
uniform vec3 u_eye;     // in the world
uniform vec3 u_key;     // where the light comes from
uniform vec3 u_base;    // colour of the body
uniform vec3 u_sky;
uniform vec3 u_earth;
uniform vec4 u_cut;     // what lies before this plane is not drawn: normal, and its place; zero: all is
out vec4 o_color;
void cut() {
    if (dot(u_cut.xyz, v_world) > u_cut.w) {
        discard;
    }
}
vec3 shade(vec3 base, vec3 n) {
    vec3 to_eye = normalize(u_eye - v_world);
    float lit = max(dot(n, u_key), 0.0);
    vec3 around = mix(u_earth, u_sky, 0.5 + 0.5 * n.y);
    float rim = pow(1.0 - max(dot(n, to_eye), 0.0), 3.0);
    vec3 h = normalize(u_key + to_eye);
    return base * (around + 0.62 * lit) + 0.10 * rim * u_sky + 0.06 * pow(max(dot(n, h), 0.0), 40.0);
}
`;

// The triangles are near the surface: the maps say where on the pixel's ray it is, its normal, and who decides.
export const kSurfaceFragment = `${kColorsGlsl}${kShade}
uniform vec3 u_eye_object;
uniform float u_spacing;
uniform int u_map;  // whose texels are coloured; -1: none, -2: all, each its own colour
void main() {
    cut();
    vec3 d = normalize(v_object - u_eye_object);
    vec3 flat_normal = cross(dFdx(v_world), dFdy(v_world));
    flat_normal *= dot(flat_normal, u_eye - v_world) < 0.0 ? -1.0 : 1.0;
    vec3 outer = v_object - u_spacing * d;
    vec3 inner = v_object + u_spacing * d;
    bool met = !reliefInside(reliefSolid(outer)) && reliefInside(reliefSolid(inner));
    for (int i = 0; i < 7 && met; ++i) {
        vec3 middle = 0.5 * (outer + inner);
        if (reliefInside(reliefSolid(middle))) {
            inner = middle;
        } else {
            outer = middle;
        }
    }
    ReliefField field = reliefSolid(inner);
    if (!met) {
        // A sheet thinner than the grid, or the edge of the picture: whoever is nearest there.
        field = reliefEvaluate(v_object);
    }
    // Where the field is deep, a map's box ends and no surface of it: its side is flat.
    bool known = field.map >= 0 && abs(field.distance) < 2.0 * u_spacing;
    vec3 n = known ? mat3(u_model) * field.normal : flat_normal;
    n = dot(n, n) > 0.0 ? normalize(n) : normalize(flat_normal);
    n *= !met && dot(n, u_eye - v_world) < 0.0 ? -1.0 : 1.0;
    vec3 base = u_base;
    if (u_map == -2) {
        base = field.map < 0 ? base : mapColor(field.map);
    } else if (u_map >= 0) {
        base = field.map == u_map ? mapColor(u_map) : mix(base, vec3(dot(base, vec3(0.333))), 0.7) * 0.75;
    }
    o_color = vec4(shade(base, n), 1.0);
}`;

const kMeshNormal = `
vec3 meshNormal() {
    vec3 n = normalize(cross(dFdx(v_world), dFdy(v_world)));
    return dot(n, u_eye - v_world) < 0.0 ? -n : n;
}
`;

export const kMeshFragment = `${kShade}${kMeshNormal}
void main() {
    cut();
    o_color = vec4(shade(u_base, meshNormal()), 1.0);
}`;

// What the maps say of the mesh's own points, where the truth is 0, or the depth of a sheet in its shell.
export const kHeatFragment = `${kColorsGlsl}${kShade}${kMeshNormal}
uniform float u_range;
uniform float u_depth;
void main() {
    cut();
    ReliefField field = reliefEvaluate(v_object);
    float off = field.distance < -0.5 * u_depth ? field.distance + u_depth : field.distance;
    vec3 base = fieldColor(off, field.map, u_range);
    o_color = vec4(mix(base, shade(base, meshNormal()), 0.45), 1.0);
}`;

export const kSliceFragment = `${kColorsGlsl}
in vec3 v_object;
in vec3 v_world;
uniform float u_range;
out vec4 o_color;
void main() {
    ReliefField field = reliefEvaluate(v_object);
    vec3 color = fieldColor(field.distance, field.map, u_range);
    bool known = field.map >= 0 && field.distance < 1e29;
    float f = known ? field.distance : 1e3 * u_range;
    // The outline, and fainter lines at fifths of the range; none where the distance jumps.
    float pixel = length(vec2(dFdx(f), dFdy(f)));
    float size = length(fwidth(v_object));
    if (known && pixel < 4.0 * size && pixel > 0.0) {
        float level = 0.2 * u_range;
        float beside = abs(f / level - floor(f / level + 0.5)) * level / pixel;
        color = mix(color, vec3(0.13, 0.14, 0.16), 0.16 * (1.0 - smoothstep(0.4, 1.1, beside)));
        color = mix(color, vec3(0.13, 0.14, 0.16), 0.9 * (1.0 - smoothstep(0.8, 1.7, abs(f) / pixel)));
    }
    o_color = vec4(color, 1.0);
}`;

// A floor that fades with the distance from the bodies, with a shadow where they stand.
export const kFloorFragment = `
in vec3 v_object;
in vec3 v_world;
uniform vec3 u_background;
uniform vec3 u_line;
uniform vec3 u_middle;
uniform float u_radius;
uniform float u_grid;
out vec4 o_color;
void main() {
    vec2 at = v_world.xz - u_middle.xz;
    float away = length(at) / u_radius;
    float there = 1.0 - smoothstep(0.35, 1.0, away);
    vec2 cell = v_world.xz / u_grid;
    vec2 beside = abs(fract(cell - 0.5) - 0.5) / max(fwidth(cell), 1e-5);
    float line = 1.0 - min(min(beside.x, beside.y), 1.0);
    vec3 color = mix(u_background, u_line, 0.16 + 0.5 * line);
    o_color = vec4(color, there * 0.9);
}`;

export const kSkyFragment = `
in vec2 v_uv;
uniform vec3 u_low;
uniform vec3 u_high;
out vec4 o_color;
void main() {
    o_color = vec4(mix(u_low, u_high, smoothstep(0.0, 1.0, v_uv.y)), 1.0);
}`;

// The picture of the bodies, kept from frame to frame: colours averaged, and depths for what comes on top.
export const kCopyFragment = `
precision highp sampler2D;
uniform sampler2D u_color;
uniform sampler2D u_depth;
uniform int u_fine;
out vec4 o_color;
void main() {
    ivec2 at = u_fine * ivec2(gl_FragCoord.xy);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < u_fine; ++y) {
        for (int x = 0; x < u_fine; ++x) {
            sum += texelFetch(u_color, at + ivec2(x, y), 0).rgb;
        }
    }
    o_color = vec4(sum / float(u_fine * u_fine), 1.0);
    gl_FragDepth = texelFetch(u_depth, at, 0).r;
}`;
