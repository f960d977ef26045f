// SPDX-License-Identifier: Apache-2.0
// Paints a tile per work group: its sprites from the last to the first, which is from the nearest to the farthest if
// they are sorted, until the background is no longer visible.
layout(local_size_x = RELIEF_TILE_SIDE, local_size_y = RELIEF_TILE_SIDE) in;
//!include picture/sprite_paint.glsl
//!include picture/tile.glsl
//!include base/group_barrier.glsl
layout(std430, binding = 0) readonly buffer Entries { uvec2 b_entries[]; };
layout(std430, binding = 1) readonly buffer Sprites { uvec4 b_sprites[]; };
layout(std430, binding = 2) readonly buffer Bounds { uvec2 b_bounds[]; };
layout(std430, binding = 3) readonly buffer Work { uint b_work[RELIEF_TILE_WORDS]; };
layout(rgba16f, binding = 0) writeonly uniform highp image2D u_layer;

uniform highp sampler2D u_hides;   // window depth of the target
uniform bool u_hidden;             // u_hides is valid
uniform highp sampler2D u_behind;  // window depth behind the sprites
uniform bool u_adds;               // additive sprites, which hide nothing

const uint BATCH = uint(RELIEF_TILE_SIDE * RELIEF_TILE_SIDE);
// Below 1/1024, the background is invisible at 8 bits per channel.
const float CLEAR = 1.0 / 1024.0;
// Limit of the squared radius: includes the corners of a cell, but not those of a disc.
#ifdef RELIEF_CELLS
const float MOST_SQUARE = 2.01;
#else
const float MOST_SQUARE = 1.0;
#endif

shared uint s_open;       // an invocation still sees the background
shared uvec4 s_place[RELIEF_TILE_SIDE * RELIEF_TILE_SIDE];
shared uvec4 s_paint[RELIEF_TILE_SIDE * RELIEF_TILE_SIDE];
#if defined(RELIEF_CELLS) || defined(RELIEF_STRETCH)
#define TURNS 1
shared uvec2 s_turn[RELIEF_TILE_SIDE * RELIEF_TILE_SIDE];
#endif

// Returns the position of a pixel within a sprite, in the picture's frame, -1…1 for an unrotated sprite. away: pixels
// from the sprite's centre to the pixel's centre. Values beyond 2 are outside.
vec2 placeIn(uint i, vec2 away, float pixels) {
#if defined(RELIEF_QUADS) && defined(TURNS)
    vec2 turn = unpackSnorm2x16(s_turn[i].x);
    float longer = uintBitsToFloat(s_turn[i].y);
    vec2 own = 2.0 * vec2(dot(away, turn) / (pixels + longer), (away.y * turn.x - away.x * turn.y) / pixels);
    return max(abs(own.x), abs(own.y)) > 1.0 ? vec2(9.0) : own.x * turn + own.y * vec2(-turn.y, turn.x);
#else
    vec2 at = away * (2.0 / pixels);
    return max(abs(at.x), abs(at.y)) > 1.0 ? vec2(9.0) : at;
#endif
}

void main() {
    uint self = gl_LocalInvocationIndex;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 known = min(pixel, u_picture - 1);
    uvec2 bounds = b_bounds[int(gl_WorkGroupID.y) * u_tiles.x + int(gl_WorkGroupID.x)];
    uint first = bounds.x;
    float hides = u_hidden ? texelFetch(u_hides, known, 0).r : 1.0;
    float behind = u_soft > 0.0 ? texelFetch(u_behind, known, 0).r : 1.0;
    vec4 sum = vec4(0.0);
    float clear = known == pixel ? 1.0 : 0.0;  // visible fraction of the background
    for (uint end = b_work[6] == 0u ? bounds.y : first; end > first;) {
        uint count = min(end - first, BATCH);
        if (self < count) {
            uint rank = b_entries[end - 1u - self].x;
            s_place[self] = b_sprites[3u * rank];
            s_paint[self] = b_sprites[3u * rank + 1u];
#ifdef TURNS
            s_turn[self] = b_sprites[3u * rank + 2u].zw;
#endif
        }
        s_open = 0u;
        groupBarrier();
        for (uint i = 0u; i < count && clear > CLEAR; ++i) {
            vec4 place = uintBitsToFloat(s_place[i]);
            vec2 at = placeIn(i, vec2(pixel) + 0.5 - place.xy, place.z);
            float square = dot(at, at);
            if (square > MOST_SQUARE || place.w > hides) {
                continue;
            }
            Shading shading = unpackShading(s_paint[i].xyz);
            float radius = sqrt(square);
#ifdef RELIEF_CELLS
            vec4 cell = vec4(unpackSnorm2x16(s_turn[i].x), uintBitsToFloat(s_paint[i].w), place.z);
            vec4 body = bodyAt(at, radius, shading.per_edge, cell);
#else
            vec4 body = bodyAt(at, radius, shading.per_edge);
#endif
            float shown = shading.opacity * (u_soft > 0.0 ? softFraction(behind, place.w) : 1.0);
            vec4 paint = paintOf(shading, at, radius, body, shown);
            sum += clear * paint;
            clear *= u_adds ? 1.0 : 1.0 - paint.a;
        }
        if (clear > CLEAR) {
            s_open = 1u;
        }
        groupBarrier();
        if (s_open == 0u) {
            break;
        }
        end -= count;
        groupBarrier();
    }
    if (known == pixel) {
        imageStore(u_layer, pixel, sum);
    }
}
