// Makes the sprites, each once, and counts the tiles of each group of them.
//!include radix.glsl
//!include grain_make.glsl
//!include grain_place.glsl
//!include tile.glsl
layout(std430, binding = 0) writeonly buffer Sprites { uvec4 b_sprites[]; };
layout(std430, binding = 2) writeonly buffer Counts { uint b_counts[]; };

shared uint s_count;

void main() {
    uint self = gl_LocalInvocationIndex;
    uint rank = gl_WorkGroupID.x * uint(RELIEF_RADIX_DIGITS) + self;
    if (self == 0u) {
        s_count = 0u;
    }
    meet();
    uvec4 place = uvec4(0u);
    uvec4 paint = uvec4(0u);
    Sprite sprite;
    if (rank < u_count && spriteOf(int(rank), sprite)) {
        vec4 clip = placeOf(sprite);
        // Between the near and the far plane. Its centre may be out of the picture.
        if (clip.w > 0.0 && abs(clip.z) <= clip.w) {
            vec3 window = 0.5 * clip.xyz / clip.w + 0.5;
            vec2 at = window.xy * u_target;
            place = floatBitsToUint(vec4(at, sprite.pixels, window.z));
            paint = uvec4(packGrain(sprite.grain), 0u);
            atomicAdd(s_count, tileCount(tilesOf(at, sprite.pixels)));
        }
    }
    if (rank < u_count) {
        b_sprites[2u * rank] = place;
        b_sprites[2u * rank + 1u] = paint;
    }
    meet();
    if (self == 0u) {
        b_counts[gl_WorkGroupID.x] = s_count;
    }
}
