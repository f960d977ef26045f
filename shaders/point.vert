// Particles as sprites that face the viewer: vertex i fetches its particle from the state textures, nothing is read
// back. A particle is one point or, with RELIEF_QUADS, two triangles of six vertices:
//
//     5───4 2      A quad turns in the picture's plane; a point stays upright and its fragments turn. Both
//     │  ╱ ╱│      cover the same pixels of a sprite that does not turn.
//     3 0───1
//
// With RELIEF_LIT the collider shades the particles, as particle_light.frag says; else they lie in the open.
//!include look.glsl
//!include sky.glsl

uniform highp sampler2D u_position;
uniform highp sampler2D u_birth;
uniform highp usampler2D u_order;  // row by row: the index of the i-th sprite; 0 where there is none
uniform bool u_ordered;
uniform int u_width;
uniform int u_extent;
uniform float u_now;
uniform mat4 u_view;
uniform mat4 u_projection;
uniform float u_pixels_per_unit;  // pixels of a unit length at view distance 1
uniform vec2 u_pixels;            // least and largest sprite
uniform vec2 u_target;            // pixels
uniform vec2 u_depth;             // window depth of view distance t: x + y / t
#ifdef RELIEF_LIT
uniform highp sampler2D u_light;
#endif

flat out vec3 v_sun;   // what a grain receives from the sun, and from above and below
flat out vec3 v_above;
flat out vec3 v_below;
flat out vec3 v_color;
flat out float v_alpha;
flat out float v_pixels;
flat out float v_lit;
flat out float v_cell;
flat out float v_front;  // view distance of the grain's front
flat out vec2 v_turn;    // cosine and sine of its rotation
#ifdef RELIEF_QUADS
out vec2 v_corner;       // in the sprite's own frame, -1…1, y upwards
#endif

void nothing() {  // beyond the far plane
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    v_sun = v_above = v_below = v_color = vec3(0.0);
    v_alpha = v_lit = 0.0;
    v_pixels = v_front = 1.0;
    v_cell = -1.0;
    v_turn = vec2(1.0, 0.0);
#ifdef RELIEF_QUADS
    v_corner = vec2(0.0);
#else
    gl_PointSize = 1.0;
#endif
}

// The particle of the i-th sprite; -1: none.
int particleOf(int i) {
    int width = textureSize(u_order, 0).x;
    uvec4 rank = texelFetch(u_order, ivec2(i % width, i / width), 0);
    return rank.y != 0u ? int(min(rank.x, 2147483647u)) : -1;
}

// How much nearer than its centre a grain's front is, as a share of the view distance. The depth is that of the front,
// so that grains on a surface are not half sunk into it; the place on the picture that of the centre. A large sprite's
// front does not pass the near plane before its centre does.
float nearerShare(float size, float distance) {
    float near = -u_depth.y / u_depth.x;
    return max(1.0 - 0.5 * size / distance, clamp(1.01 * near / distance, 0.05, 1.0));
}

void receiveLight(ivec2 texel) {
#ifdef RELIEF_LIT
    vec4 light = texelFetch(u_light, texel, 0);
    v_sun = SUN_COLOR * light.x;
    v_above = light.yzw;
#else
    v_sun = SUN_COLOR;
    v_above = SKY_COLOR;
#endif
    v_below = FLOOR_COLOR;
}

void main() {
#ifdef RELIEF_QUADS
    int index = gl_VertexID / RELIEF_QUAD_VERTICES;
    int corner = gl_VertexID - RELIEF_QUAD_VERTICES * index;
#else
    int index = gl_VertexID;
#endif
    if (u_ordered) {
        index = particleOf(index);
    }
    if (index < 0 || index >= u_extent) {
        nothing();
        return;
    }
    ivec2 texel = ivec2(index % u_width, index / u_width);
    vec4 position = texelFetch(u_position, texel, 0);
    if (position.w < 0.0) {  // dead
        nothing();
        return;
    }
    vec4 birth = texelFetch(u_birth, texel, 0);
    Look look = lookOf(birth, u_now);
    vec4 in_view = u_view * vec4(position.xyz, 1.0);
    gl_Position = u_projection * in_view;
    float distance = max(-in_view.z, 1e-6);
    float nearer = nearerShare(look.size, distance);
    vec4 front = u_projection * vec4(in_view.xyz * nearer, 1.0);
    gl_Position.z = front.z / front.w * gl_Position.w;
    v_front = nearer * distance;

    // Below the least size a sprite keeps its light by losing opacity instead.
    float wanted = look.size * u_pixels_per_unit / distance;
    v_pixels = clamp(wanted, u_pixels.x, u_pixels.y);
    float cover = min(wanted / v_pixels, 1.0);
    v_alpha = look.opacity * cover * cover;
    v_turn = vec2(cos(look.rotation), sin(look.rotation));
    v_color = look.color;
    v_cell = look.cell;
    v_lit = look.lit;
#ifdef RELIEF_QUADS
    v_corner = vec2(corner == 1 || corner == 2 || corner == 4 ? 1.0 : -1.0, corner == 2 || corner >= 4 ? 1.0 : -1.0);
    vec2 turned = vec2(v_turn.x * v_corner.x - v_turn.y * v_corner.y, v_turn.y * v_corner.x + v_turn.x * v_corner.y);
    gl_Position.xy += turned * (v_pixels / u_target) * gl_Position.w;
#else
    gl_PointSize = v_pixels;
#endif

    receiveLight(texel);
}
