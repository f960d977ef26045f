// SPDX-License-Identifier: Apache-2.0
// The events of a step, as step_event.glsl writes them.
uniform highp sampler2D u_event_surface;
uniform highp sampler2D u_birth;
// Of each list:
uniform float u_min_speed[RELIEF_EVENT_LISTS];     // slower hits do not count
uniform int u_event_kinds[RELIEF_EVENT_LISTS];     // sums of 1: hits that begin, 2: hits that last, 4: deaths
uniform int u_event_type[RELIEF_EVENT_LISTS];      // others do not count; -1: all do
uniform int u_event_material[RELIEF_EVENT_LISTS];  // hits on others do not count: number of its name + 1; -1: all do
uniform int u_materials;  // names of materials, + 1

// The number of the material's name + 1, or 0 without one.
int materialOf(int code) {
    return code / (RELIEF_EVENT_FLAGS * RELIEF_EVENT_DIRECTIONS) % u_materials;
}

// Whether the event of a particle, if there is one, is in a list.
// surface: as step_event.glsl writes it.
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
