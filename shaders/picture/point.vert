// SPDX-License-Identifier: Apache-2.0
// Renders particles as viewer-facing sprites directly from the state textures, without read-back. A particle is one
// point or, with RELIEF_QUADS, two triangles with six vertices:
//
//     5───4 2      A quad rotates in the picture's plane. A point stays upright and its fragments rotate the
//     │  ╱ ╱│      texture. Both cover the same pixels if the sprite is not rotated.
//     3 0───1
//
// RELIEF_CELLS: use an atlas.
//!include picture/sprite.glsl
//!include picture/sprite_place.glsl

flat out uvec3 v_shading;
#ifdef RELIEF_CELLS
flat out vec4 v_cell;    // cosine and sine of its rotation; atlas cell, -1: a soft disc; pixels
#endif
#ifdef RELIEF_QUADS
out vec2 v_at;           // in the picture's frame, -1…1 for an unrotated sprite, y upwards
#endif

void nothing() {  // moves the vertex beyond the far plane
    gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
    v_shading = uvec3(0u);
#ifdef RELIEF_CELLS
    v_cell = vec4(1.0, 0.0, -1.0, 1.0);
#endif
#ifdef RELIEF_QUADS
    v_at = vec2(0.0);
#else
    gl_PointSize = 1.0;
#endif
}

void main() {
#ifdef RELIEF_QUADS
    int rank = gl_VertexID / RELIEF_QUAD_VERTICES;
    int corner = gl_VertexID - RELIEF_QUAD_VERTICES * rank;
#else
    int rank = gl_VertexID;
#endif
    Sprite sprite;
    if (!spriteOf(rank, sprite)) {
        nothing();
        return;
    }
    gl_Position = placeOf(sprite);
    v_shading = packShading(sprite.shading);
    float pixels = sprite.pixels;
#if defined(RELIEF_STRETCH)
    vec2 tail = tailOf(sprite);
    float tail_pixels = length(tail);
    vec2 turn = turnOf(sprite, tail);
#elif defined(RELIEF_CELLS) || defined(RELIEF_QUADS)
    vec2 turn = turnOf(sprite, vec2(0.0));
#endif
#ifdef RELIEF_CELLS
    v_cell = vec4(turn, sprite.cell, pixels);
#endif
#ifdef RELIEF_QUADS
    vec2 own = vec2(corner == 1 || corner == 2 || corner == 4 ? 1.0 : -1.0, corner == 2 || corner >= 4 ? 1.0 : -1.0);
    vec2 along = own.x * turn;
    vec2 across = own.y * vec2(-turn.y, turn.x);
    v_at = along + across;
#ifdef RELIEF_STRETCH
    vec2 offset = (pixels + tail_pixels) * along + pixels * across + tail;
#else
    vec2 offset = pixels * v_at;
#endif
    gl_Position.xy += offset / u_target * gl_Position.w;
#else
    gl_PointSize = pixels;
#endif
}
