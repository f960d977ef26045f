// One sprite: a soft round grain or, with RELIEF_CELLS, a cell of the atlas; either shaded as the half of a ball that
// faces the viewer.
//!include grain_paint.glsl

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
    return vec4(roundAt(radius, per_edge));
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
    if (u_soft > 0.0) {
        shown *= softShare(texelFetch(u_behind, ivec2(gl_FragCoord.xy), 0).r, gl_FragCoord.z);
    }
    o_color = paintOf(grain, at, radius, body, shown);
    if (o_color.a == 0.0) {
        discard;
    }
}
