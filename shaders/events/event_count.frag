// SPDX-License-Identifier: Apache-2.0
// Sums RELIEF_EVENTS_PER_COUNT consecutive entries for each list: particles with a matching event or, with
// RELIEF_EVENT_SUMS, counts.
#if defined(RELIEF_EVENT_SUMS)
uniform highp sampler2D u_counts;
#else
//!include events/events.glsl
#endif
uniform int u_width;  // entries per row of their textures
uniform int u_count;  // number of entries

layout(location = 0) out vec4 o_count;

vec4 countOf(ivec2 texel) {
#if defined(RELIEF_EVENT_SUMS)
    return texelFetch(u_counts, texel, 0);
#else
    vec4 surface = texelFetch(u_event_surface, texel, 0);
    vec4 count = vec4(0.0);
    for (int list = 0; list < RELIEF_EVENT_LISTS; ++list) {
        count[list] = surface.w > 0.0 && countsIn(list, texel, surface) ? 1.0 : 0.0;
    }
    return count;
#endif
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    int first = (at.y * RELIEF_EVENTS_WIDTH + at.x) * RELIEF_EVENTS_PER_COUNT;
    int end = min(first + RELIEF_EVENTS_PER_COUNT, u_count);
    vec4 count = vec4(0.0);
    for (int i = first; i < end; ++i) {
        count += countOf(ivec2(i % u_width, i / u_width));
    }
    o_count = count;
}
