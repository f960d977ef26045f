// SPDX-License-Identifier: Apache-2.0
// Computes each sprite once, and counts the tiles of each group of sprites.
//!include picture/radix.glsl
//!include picture/sprite.glsl
//!include picture/sprite_place.glsl
//!include picture/tile.glsl
layout(std430, binding = 0) writeonly buffer Sprites { uvec4 b_sprites[]; };
layout(std430, binding = 2) writeonly buffer Counts { uint b_counts[]; };

// Sprites that are larger, or farther outside the picture, are skipped.
const float MOST_PIXELS = 1e20;

shared uint s_count;

void main() {
    uint self = gl_LocalInvocationIndex;
    uint rank = gl_WorkGroupID.x * uint(RELIEF_RADIX_DIGITS) + self;
    if (self == 0u) {
        s_count = 0u;
    }
    groupBarrier();
    uvec4 place = uvec4(0u);
    uvec4 paint = uvec4(0u);
    uvec4 shape = uvec4(NO_TILES, 0u, 0u);
    Sprite sprite;
    if (rank < u_count && spriteOf(int(rank), sprite)) {
        vec4 clip = placeOf(sprite);
        // Keep sprites between the near and far planes; their centre may be outside the picture. Packing rounds the
        // opacity.
        if (clip.w > 0.0 && abs(clip.z) <= clip.w && sprite.shading.opacity > SPRITE_UNSEEN - 1e-4) {
            vec3 window = 0.5 * clip.xyz / clip.w + 0.5;
            vec2 at = window.xy * u_target;
            vec2 turn = vec2(1.0, 0.0);
            float longer = 0.0;
#ifdef RELIEF_STRETCH
            vec2 tail = tailOf(sprite);
            at += 0.5 * tail;
            longer = length(tail);
            turn = turnOf(sprite, tail);
#elif defined(RELIEF_CELLS)
            turn = turnOf(sprite, vec2(0.0));
#endif
            vec2 reach = vec2(0.5 * sprite.pixels);
#ifdef RELIEF_QUADS
            vec2 along = abs(turn);
            reach = 0.5 * ((sprite.pixels + longer) * along + sprite.pixels * along.yx);
#endif
            if (all(lessThan(abs(at) + reach, vec2(MOST_PIXELS)))) {  // false for NaN
                place = floatBitsToUint(vec4(at, sprite.pixels, window.z));
                paint = uvec4(packShading(sprite.shading), floatBitsToUint(sprite.cell));
                shape = uvec4(tilesOf(at, reach), packSnorm2x16(turn), floatBitsToUint(longer));
                atomicAdd(s_count, tileCount(shape.xy));
            }
        }
    }
    if (rank < u_count) {
        b_sprites[3u * rank] = place;
        b_sprites[3u * rank + 1u] = paint;
        b_sprites[3u * rank + 2u] = shape;
    }
    groupBarrier();
    if (self == 0u) {
        b_counts[gl_WorkGroupID.x] = s_count;
    }
}
