// SPDX-License-Identifier: Apache-2.0
// Shaders that draw a body: its maps, its mesh, slices, the floor.
import { kColorsGlsl } from "./colors.js";
import { kRayGlsl } from "./ray_shader.js";

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

// Like kBodyVertex, for a deforming mesh with vertices in a texture (LiveMesh in relief.d.ts).
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

// Shading by a key light from above left of the camera, ambient light of sky and earth, and a rim light.
const kShade = `
in vec3 v_object;
in vec3 v_world;
uniform mat4 u_model;
uniform vec3 u_eye;     // world space
uniform vec3 u_key;     // direction to the key light
uniform vec3 u_base;    // colour of the body
uniform vec3 u_sky;
uniform vec3 u_earth;
uniform vec4 u_cut;     // fragments in front of this plane (normal, offset) are discarded; zero: none
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

// Drawn on the back faces of the collider's box: follows the ray of each pixel through the maps to the first inside
// point.
export const kSurfaceFragment = `${kColorsGlsl}${kShade}${kRayGlsl}
uniform mat4 u_camera;
uniform vec3 u_box_min;
uniform vec3 u_box_max;
uniform float u_deep;   // maximum depth of a nearby surface; deeper votes occur where a flat side of a map's box cuts the body
uniform int u_map;      // map whose texels are coloured; -1: none, -2: all maps, each in its own colour
// Returns the colour of map i at p; for patches, it depends on the cell size.
vec3 colorOf(int i, vec3 p) {
#if defined(RELIEF_HAS_PATCHES)
    if (reliefIsPatches(u_relief_maps[i].info)) {
        ivec4 place = u_relief_maps[i].place;
        vec3 q = clamp(reliefInMap(i, p), vec3(0.0), reliefPatchRoots(i) * (1.0 - 1e-6));
        ReliefLeaf leaf = reliefPatchLeaf(u_relief_front_back, place, q);
        float level = -log2(hasNoRecord(leaf) ? 0.5 * leaf.cell : leaf.cell);
        return levelColor(i, level / max(float(place.w), 1.0));
    }
#endif
    return mapColor(i);
}
void main() {
    vec3 eye = (inverse(u_model) * vec4(u_eye, 1.0)).xyz;
    vec3 d = normalize(v_object - eye);
    vec3 enters, leaves;
    slabs(eye, d, u_box_min, u_box_max, enters, leaves);
    float to_box = max(max(enters.x, enters.y), enters.z);
    float from = max(to_box, 0.0);
    float until = min(min(leaves.x, leaves.y), leaves.z);
    vec3 side = enters.x == to_box ? vec3(sign(d.x), 0.0, 0.0) : enters.y == to_box ? vec3(0.0, sign(d.y), 0.0)
        : vec3(0.0, 0.0, sign(d.z));
    vec3 n = -(mat3(u_model) * side);  // normal if the body starts at the box
    float before = dot(u_cut.xyz, u_eye) - u_cut.w;
    float rate = dot(u_cut.xyz, mat3(u_model) * d);
    float behind = 0.0;
    if (before > 0.0) {
        float plane = rate < 0.0 ? -before / rate : NEVER;
        if (plane > from) {
            from = plane;
            n = u_cut.xyz;
            behind = 1.0;
        }
    } else if (rate > 0.0) {
        until = min(until, -before / rate);
    }
    if (from >= until) {
        discard;
    }
    vec3 origin = eye + from * d;
    float far = until - from;
    Hit hit;
    bool within = false;  // the eye is in the body: search for the exit
    bool begins = false;  // the ray starts inside
    for (int k = 0; k < 2; ++k) {  // a single call, because compilers inline each call
        hit = follow(origin, d, 0.0, far, within);
        begins = begins || hit.t == 0.0;
        if (within || !begins || from > 0.0) {
            break;
        }
        within = true;
    }
    if (hit.t >= far) {
        discard;
    }
    float inwards = within ? -u_tiny : min(0.5 * (hit.ends - hit.t), 20.0 * u_tiny);
    vec3 probe;
    ReliefField field;
    bool known = false;
    for (int k = 0; k < 2 && !known; ++k) {  // deeper, in case maps end just before the surface of another map
        probe = origin + (hit.t + inwards) * d;
        field = reliefSolid(probe);
        known = field.map >= 0 && abs(field.distance) < u_deep && (k == 0 || field.distance < 0.0);
        inwards = (within ? -0.2 : 0.2) * u_deep;
    }
    if (!begins || within) {
        n = known && dot(field.normal, field.normal) > 0.0 ? field.normal : -d;
#if defined(RELIEF_HAS_PATCHES)
        // A visible surface cannot face away: the ray entered through the side of a cell whose patch is of another
        // surface, as in a thin wall. Use the surface of the previous cell.
        if (!within && dot(n, d) > 0.0) {
            ReliefField before = reliefEvaluate(origin + (hit.t - u_tiny) * d);
            n = before.distance < u_deep && dot(before.normal, d) < 0.0 ? before.normal : -d;
        }
#endif
        if (!known && hit.map >= 0 && hit.border >= 0) {
            n = u_relief_maps[hit.map].row[hit.border].xyz;
            n *= -sign(dot(n, d));
        }
        n = mat3(u_model) * (within ? -n : n);
    }
    n = normalize(n);
    vec3 base = u_base;
    if (u_map == -2) {
        base = field.map < 0 ? base : colorOf(field.map, probe);
    } else if (u_map >= 0) {
        base = field.map == u_map ? colorOf(u_map, probe) : mix(base, vec3(dot(base, vec3(0.333))), 0.7) * 0.75;
    }
    o_color = vec4(shade(base, n), 1.0);
    // The cut surface is drawn behind the picture of the slice.
    float at = hit.t + (begins && !within ? behind * 100.0 * u_tiny : 0.0);
    vec4 clip = u_camera * (u_model * vec4(origin + at * d, 1.0));
    gl_FragDepth = clamp(0.5 + 0.5 * clip.z / clip.w, 0.0, 1.0);
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

// Colours the mesh by the distance of the maps. The true distance is 0, or the depth of a sheet in its shell.
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
    // Draw the outline, and fainter lines at fifths of the range, but not where the distance is discontinuous.
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

// A grid on the floor that fades with the distance from the bodies.
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

// Copies the kept picture of the bodies: averages the colours, and copies the depths for particles drawn on top.
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
