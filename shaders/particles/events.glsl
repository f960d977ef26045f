// The events of a step, as step_event.glsl writes them.
uniform highp sampler2D u_event_surface;
uniform highp sampler2D u_birth;
uniform float u_min_speed;     // slower hits do not count
uniform int u_event_type;      // others do not count; -1: all do
uniform int u_event_material;  // hits on others do not count: number of its name + 1; -1: all do
uniform int u_materials;       // names of materials, + 1
uniform ivec3 u_event_kinds;   // 1 where hits that begin, hits that last, and deaths count; else 0

// The number of the material's name + 1, or 0 without one.
int materialOf(int code) {
    return code / (RELIEF_EVENT_FLAGS * RELIEF_EVENT_DIRECTIONS) % u_materials;
}

bool counts(ivec2 texel) {
    vec4 surface = texelFetch(u_event_surface, texel, 0);
    int code = int(surface.w);
    int flags = code % RELIEF_EVENT_FLAGS;
    if (flags == 0 || (u_event_type >= 0 && int(texelFetch(u_birth, texel, 0).z) != u_event_type)) {
        return false;
    }
    bool hit = (flags & RELIEF_EVENT_COLLISION) != 0 && surface.z >= u_min_speed &&
               (u_event_material < 0 || materialOf(code) == u_event_material);
    bool lasts = (flags & RELIEF_EVENT_LASTS) != 0;
    bool death = (flags & RELIEF_EVENT_DEATH) != 0 && u_event_kinds.z != 0;
    return death || (hit && (lasts ? u_event_kinds.y : u_event_kinds.x) != 0);
}

ivec2 texelOf(int i, int width) {
    return ivec2(i % width, i / width);
}
