// SPDX-License-Identifier: Apache-2.0
// The events of a step, as written by step_event.glsl.
uniform highp sampler2D u_event_surface;
uniform highp sampler2D u_birth;
// For each list:
uniform float u_min_speed[RELIEF_EVENT_LISTS];     // ignores slower hits
uniform int u_event_kinds[RELIEF_EVENT_LISTS];     // sums of 1: new hits, 2: continued hits, 4: deaths
uniform int u_event_type[RELIEF_EVENT_LISTS];      // only this type; -1: all
uniform int u_event_material[RELIEF_EVENT_LISTS];  // only hits on this material, index of its name + 1; -1: all
uniform int u_materials;  // number of material names + 1

// Returns the index of the material's name + 1, or 0 without a material.
int materialOf(int code) {
    return code / (RELIEF_EVENT_FLAGS * RELIEF_EVENT_DIRECTIONS) % u_materials;
}

// Returns whether a particle has an event that belongs to a list. surface: from step_event.glsl.
bool countsIn(int list, ivec2 texel, vec4 surface) {
    int code = int(surface.w);
    int flags = code % RELIEF_EVENT_FLAGS;
    int kinds = u_event_kinds[list];
    bool hit = (flags & RELIEF_EVENT_COLLISION) != 0 && surface.z >= u_min_speed[list] &&
               (u_event_material[list] < 0 || u_event_material[list] == materialOf(code));
    bool lasts = (flags & RELIEF_EVENT_LASTS) != 0;
    bool death = (flags & RELIEF_EVENT_DEATH) != 0 && (kinds & 4) != 0;
    return (death || (hit && (kinds & (lasts ? 2 : 1)) != 0)) &&
           (u_event_type[list] < 0 || u_event_type[list] == int(texelFetch(u_birth, texel, 0).z));
}

ivec2 texelOf(int i, int width) {
    return ivec2(i % width, i / width);
}
