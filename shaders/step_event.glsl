// For step.glsl: what happened to a particle in a step, where RELIEF_EVENTS asks for it.
//
//     way texture       x y z   the velocity that it went with, world units a second
//                       w       seconds from the step's beginning to the event
//     surface texture   x y     the smaller two of the normal's components (events.glsl)
//                       z       speed of approach along the normal, relative to the surface, >= 0
//                       w       flags, direction and body (kEventFlags in shader_constants.h); 0: nothing happened
//
// A way within a step is straight, so the textures of the positions before have the rest: a particle was at
// before + w * velocity.
#if defined(RELIEF_EVENTS)

RELIEF_STATE_OUT(RELIEF_EVENT_WAY_OUT) vec4 o_event_way;
RELIEF_STATE_OUT(RELIEF_EVENT_SURFACE_OUT) vec4 o_event_surface;

void writeNoEvent() {
    o_event_way = vec4(0.0);
    o_event_surface = vec4(0.0);
}

// All but the largest component, and which one that is: 2 * axis, + 1 if it is negative.
vec3 packedNormal(vec3 n) {
    vec3 a = abs(n);
    if (a.x >= a.y && a.x >= a.z) {
        return vec3(n.y, n.z, n.x < 0.0 ? 1.0 : 0.0);
    }
    return a.y >= a.z ? vec3(n.z, n.x, n.y < 0.0 ? 3.0 : 2.0) : vec3(n.x, n.y, n.z < 0.0 ? 5.0 : 4.0);
}

// A hit from outside, where the way comes to be as deep as way.met says at its end: with vn, the velocity along the
// normal relative to the surface, it was at depth 0 so much earlier.
void writeHit(Way way, float vn, bool lasts, bool dies) {
    float after = min(vn < 0.0 ? way.met.distance / vn : 0.0, way.share * u_dt);
    vec3 normal = packedNormal(way.met.normal);
    float code = float(RELIEF_EVENT_COLLISION) + (lasts ? float(RELIEF_EVENT_LASTS) : 0.0) +
                 (dies ? float(RELIEF_EVENT_DEATH) : 0.0);
    code += float(RELIEF_EVENT_FLAGS) *
            (normal.z + float(RELIEF_EVENT_DIRECTIONS) * (float(way.met.body) + 1.0));
    o_event_way = vec4(way.v, way.end * u_dt - after);
    o_event_surface = vec4(normal.xy, max(-vn, 0.0), code);
}

void writeDeath(State state, float time) {
    o_event_way = vec4(state.velocity, clamp(time - (u_now - u_dt), 0.0, u_dt));
    o_event_surface = vec4(0.0, 0.0, 0.0, float(RELIEF_EVENT_DEATH));
}

#else

void writeNoEvent() {}
void writeHit(Way way, float vn, bool lasts, bool dies) {}
void writeDeath(State state, float time) {}

#endif
