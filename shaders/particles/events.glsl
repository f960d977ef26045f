// The events of a step, as step_event.glsl writes them.
uniform highp sampler2D u_event_surface;
uniform float u_min_speed;     // slower hits do not count
uniform ivec3 u_event_kinds;   // 1 where hits that begin, hits that last, and deaths count; else 0

bool counts(ivec2 texel) {
    vec4 surface = texelFetch(u_event_surface, texel, 0);
    int flags = int(surface.w) % RELIEF_EVENT_FLAGS;
    bool hit = (flags & RELIEF_EVENT_COLLISION) != 0 && surface.z >= u_min_speed;
    bool lasts = (flags & RELIEF_EVENT_LASTS) != 0;
    bool death = (flags & RELIEF_EVENT_DEATH) != 0 && u_event_kinds.z != 0;
    return death || (hit && (lasts ? u_event_kinds.y : u_event_kinds.x) != 0);
}

ivec2 texelOf(int i, int width) {
    return ivec2(i % width, i / width);
}
