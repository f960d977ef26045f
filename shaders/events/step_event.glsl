// SPDX-License-Identifier: Apache-2.0
// For step.glsl: the event of a particle in a step.
//
//     velocity texture  x y z   world units/s, during the step
//                       w       seconds from the start of the step to the event
//     surface texture   x y     the smaller two of the normal's components (events.glsl)
//                       z       approach speed along the normal, relative to the surface, >= 0
//                       w       flags, direction, material and body (kEventFlags in constants.h); 0: no event
//
// Paths are straight within a step: the event occurred at (position before the step) + w * velocity.
RELIEF_STATE_OUT(2) vec4 o_event_velocity;
RELIEF_STATE_OUT(3) vec4 o_event_surface;

void writeNoEvent() {
    o_event_velocity = vec4(0.0);
    o_event_surface = vec4(0.0);
}

// Returns the two smaller components, and the direction of the largest: 2 * axis, + 1 if it is negative.
vec3 packedNormal(vec3 n) {
    vec3 a = abs(n);
    if (a.x >= a.y && a.x >= a.z) {
        return vec3(n.y, n.z, n.x < 0.0 ? 1.0 : 0.0);
    }
    return a.y >= a.z ? vec3(n.z, n.x, n.y < 0.0 ? 3.0 : 2.0) : vec3(n.x, n.y, n.z < 0.0 ? 5.0 : 4.0);
}

#if defined(RELIEF_MATERIALS)
const float kMaterials = float(RELIEF_MATERIALS);
#else
const float kMaterials = 0.0;
#endif

// Writes a hit from outside, `after` seconds before the end of the sweep. vn: the velocity along the normal relative to
// the surface. material: the index of its name + 1, or 0.
void writeHit(Sweep sweep, float after, float vn, float material, bool lasts, bool dies) {
    vec3 normal = packedNormal(sweep.hit.normal);
    float code = float(RELIEF_EVENT_COLLISION) + (lasts ? float(RELIEF_EVENT_LASTS) : 0.0) +
                 (dies ? float(RELIEF_EVENT_DEATH) : 0.0);
    float place = material + (kMaterials + 1.0) * (float(sweep.hit.body) + 1.0);
    code += float(RELIEF_EVENT_FLAGS) * (normal.z + float(RELIEF_EVENT_DIRECTIONS) * place);
    o_event_velocity = vec4(sweep.v, sweep.end * u_dt - after);
    o_event_surface = vec4(normal.xy, max(-vn, 0.0), code);
}

void writeDeath(State state, float time) {
    o_event_velocity = vec4(state.velocity, clamp(time - (u_now - u_dt), 0.0, u_dt));
    o_event_surface = vec4(0.0, 0.0, 0.0, float(RELIEF_EVENT_DEATH));
}
