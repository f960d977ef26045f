// One sprite: a soft round grain or, with RELIEF_CELLS, a cell of the atlas; either shaded as the half of a ball that
// faces the viewer.
//!include grain.glsl
//!include grain_light.glsl
//!include srgb.glsl

flat in uvec3 v_grain;
#ifdef RELIEF_CELLS
flat in vec4 v_cell;
#endif
#ifdef RELIEF_QUADS
in vec2 v_at;
#endif

uniform highp sampler2D u_atlas;  // linear, premultiplied by alpha
uniform ivec2 u_cells;            // columns, rows
uniform float u_levels_max;       // above it cells would run into each other
uniform highp sampler2D u_behind; // window depth of what lies behind
uniform float u_soft;             // object units; 0: hard edges
uniform vec2 u_depth;             // window depth of view distance t: x + y / t
uniform bool u_srgb;              // the target holds sRGB values

layout(location = 0) out vec4 o_color;  // premultiplied by alpha

#ifdef RELIEF_CELLS
// The atlas at a place of the cell, -1…1, y upwards.
vec4 cellAt(vec2 at) {
    vec2 size = vec2(textureSize(u_atlas, 0)) / vec2(u_cells);
    // The level at which a texel is a pixel: known, as the sprite's size is.
    float level = clamp(floor(log2(max(size.x, size.y) / v_cell.w) + 0.5), 0.0, u_levels_max);
    vec2 edge = 0.5 * exp2(level) / size;  // half a texel: filtering must not reach the next cell
    int cell = int(v_cell.z) % (u_cells.x * u_cells.y);
    vec2 inside = clamp(vec2(0.5, -0.5) * at + 0.5, edge, 1.0 - edge);
    return textureLod(u_atlas, (vec2(cell % u_cells.x, cell / u_cells.x) + inside) / vec2(u_cells), level);
}
#endif

// The sprite at `at`, of which the picture's frame is: colour times alpha, and alpha.
vec4 bodyAt(vec2 at, float radius, float per_edge) {
#ifdef RELIEF_CELLS
    if (v_cell.z >= 0.0) {
        // Its own frame turns.
        vec2 own = vec2(v_cell.x * at.x + v_cell.y * at.y, v_cell.x * at.y - v_cell.y * at.x);
        // The corners of a turned cell stand out of its point.
        return max(abs(own.x), abs(own.y)) > 1.0 ? vec4(0.0) : cellAt(own);
    }
#endif
    float inside = clamp((1.0 - radius) * per_edge, 0.0, 1.0);
    return vec4(inside * inside * (3.0 - 2.0 * inside));  // a smooth step
}

float distanceOf(float depth) {
    return u_depth.y / (depth - u_depth.x);
}

void main() {
#ifdef RELIEF_QUADS
    vec2 at = v_at;
#else
    vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
#endif
    Grain grain = unpackGrain(v_grain);
    float radius = length(at);
    vec4 body = bodyAt(at, radius, grain.per_edge);
    float shown = grain.opacity;
    if (u_soft > 0.0) {  // a sprite lies where its front is
        float behind = distanceOf(texelFetch(u_behind, ivec2(gl_FragCoord.xy), 0).r);
        shown *= clamp((behind - distanceOf(gl_FragCoord.z)) / u_soft, 0.0, 1.0);
    }
    float alpha = shown * body.a;
    if (alpha <= 0.003) {
        discard;
    }
    vec3 light = vec3(1.0);
    if (grain.lit) {
        light = grainLight(vec3(at, sqrt(max(1.0 - radius * radius, 0.0))), grain.sun, grain.sky);
    }
    o_color = vec4(grain.color * light * (shown * body.rgb), alpha);
    if (u_srgb) {
        o_color.rgb = alpha * srgbOf(min(o_color.rgb / alpha, vec3(1.0)));
    }
}
