// A work group paints a tile: its sprites from the last to the first, which is the nearest to the farthest where they are
// sorted, until nothing behind can be seen any more.
layout(local_size_x = RELIEF_TILE_SIDE, local_size_y = RELIEF_TILE_SIDE) in;
//!include grain_paint.glsl
//!include tile.glsl
layout(std430, binding = 0) readonly buffer Entries { uvec2 b_entries[]; };
layout(std430, binding = 1) readonly buffer Sprites { uvec4 b_sprites[]; };
layout(std430, binding = 3) readonly buffer Work { uint b_work[5]; };
layout(rgba16f, binding = 0) writeonly uniform highp image2D u_layer;

uniform highp sampler2D u_hides;   // window depth of the target
uniform bool u_hidden;             // it has one
uniform highp sampler2D u_behind;  // window depth of what lies behind
uniform bool u_adds;               // sprites are added, and hide nothing

const uint BATCH = uint(RELIEF_TILE_SIDE * RELIEF_TILE_SIDE);
// What is less to be seen cannot be told in eight bits a channel.
const float CLEAR = 1.0 / 1024.0;

shared uint s_bounds[2];  // of the tile's entries
shared uint s_open;       // somebody still sees what lies behind
shared uvec4 s_place[RELIEF_TILE_SIDE * RELIEF_TILE_SIDE];
shared uvec4 s_paint[RELIEF_TILE_SIDE * RELIEF_TILE_SIDE];

void meet() {
    memoryBarrierShared();
    barrier();
}

// How many entries are of higher tiles, which come first.
uint entriesAbove(int tile) {
    uint low = 0u;
    uint high = b_work[0];
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (int(b_entries[middle].y) > tile) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    return low;
}

void main() {
    uint self = gl_LocalInvocationIndex;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    ivec2 known = min(pixel, u_picture - 1);
    if (self < 2u) {
        s_bounds[self] = entriesAbove(int(gl_WorkGroupID.y) * u_tiles.x + int(gl_WorkGroupID.x) - int(self));
    }
    float hides = u_hidden ? texelFetch(u_hides, known, 0).r : 1.0;
    float behind = u_soft > 0.0 ? texelFetch(u_behind, known, 0).r : 1.0;
    vec4 sum = vec4(0.0);
    float clear = known == pixel ? 1.0 : 0.0;  // of what lies behind is seen
    meet();
    uint first = s_bounds[0];
    for (uint end = s_bounds[1]; end > first;) {
        uint count = min(end - first, BATCH);
        if (self < count) {
            uint rank = b_entries[end - 1u - self].x;
            s_place[self] = b_sprites[2u * rank];
            s_paint[self] = b_sprites[2u * rank + 1u];
        }
        s_open = 0u;
        meet();
        for (uint i = 0u; i < count && clear > CLEAR; ++i) {
            vec4 place = uintBitsToFloat(s_place[i]);
            vec2 at = (vec2(pixel) + 0.5 - place.xy) * (2.0 / place.z);
            float square = dot(at, at);
            if (square >= 1.0 || place.w > hides) {
                continue;
            }
            Grain grain = unpackGrain(s_paint[i].xyz);
            float radius = sqrt(square);
            float shown = grain.opacity * (u_soft > 0.0 ? softShare(behind, place.w) : 1.0);
            vec4 paint = paintOf(grain, at, radius, vec4(roundAt(radius, grain.per_edge)), shown);
            sum += clear * paint;
            clear *= u_adds ? 1.0 : 1.0 - paint.a;
        }
        if (clear > CLEAR) {
            s_open = 1u;
        }
        meet();
        if (s_open == 0u) {
            break;
        }
        end -= count;
        meet();
    }
    if (known == pixel) {
        imageStore(u_layer, pixel, sum);
    }
}
