// One sprite: a soft round grain, or a cell of the atlas; either shaded as the half of a ball that faces the viewer.
flat in vec3 v_sun;
flat in vec3 v_above;
flat in vec3 v_below;
flat in vec3 v_color;
flat in float v_alpha;
flat in float v_pixels;
flat in float v_lit;
flat in float v_cell;
flat in float v_front;
flat in vec2 v_turn;
#ifdef RELIEF_QUADS
in vec2 v_corner;
#endif

uniform vec3 u_sun_view;   // unit vectors in view space
uniform vec3 u_up_view;
uniform highp sampler2D u_atlas;  // linear, premultiplied by alpha
uniform ivec2 u_cells;            // columns, rows; 0: there is no atlas
uniform float u_levels_max;       // above it cells would run into each other
uniform highp sampler2D u_behind; // window depth of what lies behind
uniform float u_soft;             // object units; 0: hard edges
uniform vec2 u_depth;             // window depth of view distance t: x + y / t

layout(location = 0) out vec4 o_color;  // premultiplied by alpha

// The atlas at a place of the cell, -1…1, y upwards.
vec4 cellAt(vec2 at) {
    vec2 size = vec2(textureSize(u_atlas, 0)) / vec2(u_cells);
    // The level at which a texel is a pixel: known, as the sprite's size is.
    float level = clamp(floor(log2(max(size.x, size.y) / v_pixels) + 0.5), 0.0, u_levels_max);
    vec2 edge = 0.5 * exp2(level) / size;  // half a texel: filtering must not reach the next cell
    int cell = int(v_cell) % (u_cells.x * u_cells.y);
    vec2 inside = clamp(vec2(0.5, -0.5) * at + 0.5, edge, 1.0 - edge);
    return textureLod(u_atlas, (vec2(cell % u_cells.x, cell / u_cells.x) + inside) / vec2(u_cells), level);
}

void main() {
    // `at` in the picture's frame, for the light; `own` in the sprite's, which turns.
#ifdef RELIEF_QUADS
    vec2 own = v_corner;
    vec2 at = vec2(v_turn.x * own.x - v_turn.y * own.y, v_turn.y * own.x + v_turn.x * own.y);
#else
    vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
    vec2 own = vec2(v_turn.x * at.x + v_turn.y * at.y, v_turn.x * at.y - v_turn.y * at.x);
#endif
    float radius = length(at);
    float shown = v_alpha;
    if (u_soft > 0.0) {
        float behind = u_depth.y / (texelFetch(u_behind, ivec2(gl_FragCoord.xy), 0).r - u_depth.x);
        shown *= clamp((behind - v_front) / u_soft, 0.0, 1.0);
    }
    vec4 body;
    if (v_cell < 0.0 || u_cells.x == 0) {
        // The edge falls off over a third of the radius, and over a pixel at least.
        float soft = max(0.35, 2.0 / v_pixels);
        body = vec4(1.0 - smoothstep(1.0 - soft, 1.0, radius));
    } else {
        if (max(abs(own.x), abs(own.y)) > 1.0) {  // the corners of a turned cell stand out of its point
            discard;
        }
        body = cellAt(own);
    }
    float alpha = shown * body.a;
    if (alpha <= 0.003) {
        discard;
    }
    vec3 n = vec3(at, sqrt(max(1.0 - radius * radius, 0.0)));
    // Snow scatters: the terminator is soft, and no side is dark.
    float sun = 0.42 + 0.58 * max((dot(n, u_sun_view) + 0.5) / 1.5, 0.0);
    vec3 light = 0.72 * sun * v_sun + mix(v_below, v_above, 0.5 + 0.5 * dot(n, u_up_view));
    light = v_lit > 0.5 ? light : vec3(1.0);
    o_color = vec4(v_color * light * (shown * body.rgb), alpha);
}
