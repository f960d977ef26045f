// SPDX-License-Identifier: Apache-2.0
// One step of the simulation: age, forces, collision reaction, Euler or Verlet integration. One fragment (with
// RELIEF_COMPUTE: one invocation) is one particle. step_solid.glsl defines the solids.
//!include particles/step_state.glsl

uniform highp sampler2D u_birth;

uniform float u_now;      // clock at the end of this step
uniform float u_dt;       // seconds
uniform vec3 u_gravity;   // world units/s^2
uniform vec3 u_wind;      // velocity of the air, world units/s
uniform float u_still;    // speed at or below which a particle in contact rests: a thousandth of a step's gravity
#if defined(RELIEF_HAS_AIR)
uniform float u_air_time;  // seconds, from airTime()
#endif
uniform float u_ground;   // height of the floor; far below everything if there is none
uniform vec4 u_types[2 * RELIEF_TYPES];  // layout: see typeOf()

struct ParticleType {
    float radius;
    float restitution;
    float slip;       // 1 - friction
    float threshold;  // no friction below this speed
    float drag;       // 1/s
    float behaviour;  // RELIEF_ON_COLLISION_BOUNCE, _STOP, _SLIDE or _DIE
    float loss;       // seconds of life that a step in contact costs
    float gravity;    // factor of u_gravity
};

// A point is inside if distance is negative. normal then points outwards, map is the deciding depth map, and body is
// the body (-1: the floor).
struct Solid {
    float distance;
    vec3 normal;
    int map;
    int body;
    vec3 motion;  // of sweep.hit, if a live body: displacement of its surface in this step; otherwise zero
};

// Returns true if a ball about p, at the start of the step, was inside the body of s at that time: either its centre or
// its point nearest to the surface hit. (Contact with another side does not count: a ball on a floor bounces off a
// wall.) free: the last step ended without contact.
bool insideBefore(vec3 p, float radius, Solid s, bool free);
// Moves a point of the body of s back to the start of the step.
vec3 pointBefore(Solid s, vec3 p);
// Moves a point with the pose of a body from the start to the end of the step.
vec3 placedNow(int body, vec3 p);
// Returns the displacement of the surface of a live body near p in this step, after placedNow(); otherwise zero.
vec3 motionOf(int body, vec3 p);
// Returns restitution and 1 - friction of a body, as factors on the values of the particle.
vec2 bodyResponse(int body);

// Returns the material of a body at a point of its surface at the end of the step; see reliefMaterial().
#if defined(RELIEF_MATERIALS)
vec4 materialOf(int body, vec3 p, vec3 n);
#else
vec4 materialOf(int body, vec3 p, vec3 n) {
    return vec4(1.0, 1.0, 0.0, 0.0);
}
#endif

// Returns the height above the floor y < u_ground.
float aboveGround(vec3 p, float radius) {
    float above = p.y - radius - u_ground;
#if defined(RELIEF_MASKS)
    above = collidesWith(1 << RELIEF_GROUND_BIT) ? above : RELIEF_FAR_OUTSIDE;
#endif
    return above;
}

// Returns the union with the floor. Inside both, the deeper one decides.
Solid orGround(Solid deepest, vec3 p, float radius) {
    float above = aboveGround(p, radius);
    if (above < deepest.distance) {
        deepest = Solid(above, vec3(0.0, 1.0, 0.0), -1, -1, vec3(0.0));
    }
    return deepest;
}

// Returns the solid, excluding the floor, that a ball about p touches at the end of the step.
Solid solid(vec3 p, float radius);

#if defined(RELIEF_TOUR)

// Returns the solid that a tour has found at p.
Solid solidOf(ReliefTour tour, vec3 p, float radius);

// As solid(); a tour of a single collider evaluates map `start` first.
Solid solidFrom(vec3 p, float radius, int start) {
    ReliefTour tour;
    reliefEnter(tour, p, start);
    while (reliefGoesOn(tour)) {
        reliefAdvance(tour);
    }
    return solidOf(tour, p, radius);
}

Solid solid(vec3 p, float radius) {
    return solidFrom(p, radius, 0);
}

#else

Solid solidFrom(vec3 p, float radius, int start) {
    return solid(p, radius);
}

#endif

Solid solidOrGround(vec3 p, float radius) {
    return orGround(solid(p, radius), p, radius);
}

//!include particles/step_sweep.glsl
#if defined(RELIEF_EVENTS)
//!layer events/step_event.glsl
#else
void writeNoEvent() {}
void writeHit(Sweep sweep, float after, float vn, float material, bool lasts, bool dies) {}
void writeDeath(State state, float time) {}
#endif

bool caught(State state, float radius, Solid s) {
    vec3 p = state.position;
    return s.body < 0 ? p.y - radius < u_ground : insideBefore(p, radius, s, state.contact == float(RELIEF_CONTACT_NONE));
}

vec3 surfaceVelocity(Solid s, vec3 p) {
    return s.body < 0 ? vec3(0.0) : (p - pointBefore(s, p)) / u_dt;
}

// Returns the velocity after gravity, fields and drag. Drag is integrated implicitly, v' = v + dt (g + k (w - v')),
// which approaches the wind for any dt. The explicit form overshoots for dt k > 1 and diverges for dt k > 2.
vec3 pushed(vec3 p, vec3 v, ParticleType type) {
    vec3 acceleration = type.gravity * u_gravity;
    vec3 air = u_wind;
#if defined(RELIEF_HAS_AIR)
    acceleration += fieldAcceleration(p, v, u_air_time);
    air += airVelocity(p, u_air_time);
#endif
    return (v + u_dt * (acceleration + type.drag * air)) * (1.0 / (1.0 + u_dt * type.drag));
}

// Returns the velocity after a bounce, relative to the surface. v_begin and `relative` are the relative velocities
// before and after this step's forces; vn and along are the normal and tangential components of `relative`.
vec3 bounced(vec3 v_begin, vec3 relative, float vn, vec3 along, vec3 n, ParticleType type, vec2 response) {
    float slide = dot(relative, relative) >= type.threshold * type.threshold ? response.y : 1.0;
    // The particle stays at p, above the surface, so it bounces with the speed that it had there, without this step's
    // forces. Thus no bounce adds energy, and bouncing ends. (At a depth step between texels, v may enter the collider
    // but point outwards: no bounce.)
    float arrives = min(max(-dot(v_begin, n), 0.0), abs(vn));
    vec3 left = slide * along + (response.x * arrives) * n;
    // Below a thousandth of a step's gravity, speed is rounding error and would cause creep.
    float still = type.gravity * u_still;
    return dot(left, left) > still * still ? left : vec3(0.0);
}

// Returns the seconds from the contact to the end of the sweep, where the depth is sweep.hit.distance. vn: the velocity
// along the normal relative to the surface.
float sinceContact(Sweep sweep, float vn) {
    return min(vn < 0.0 ? sweep.hit.distance / vn : 0.0, sweep.share * u_dt);
}

// Seconds of life that the material of this step's contact costs.
float g_cost = 0.0;

// Reacts to sweep.hit (paper, section 3.3.2); v is split along the normal n at the end of the step:
//
//      p o                    o p_next           p o      ^ p_next      caught: p is inside already.
//         \   |  outside     /                  ----\----/---------    Never pushed inwards; an inward
//      ----\--+-------------/----                    \  /              velocity is reversed.
//           v p + dt v     about to collide
State reacted(State state, Sweep sweep, ParticleType type, out bool dies) {
    vec3 p = state.position;
    vec3 n = sweep.hit.normal;
    vec3 carried = surfaceVelocity(sweep.hit, sweep.to);
    vec3 v = sweep.v;
    vec3 relative = v - carried;
    float vn = dot(relative, n);
    float contact = float(RELIEF_CONTACT_COLLIDED);
    dies = false;
    if (sweep.first && caught(state, type.radius, sweep.hit)) {
        contact = float(RELIEF_CONTACT_CAUGHT);
        if (vn < 0.0) {
            v -= (2.0 * vn) * n;
        }
    } else {
        dies = type.behaviour == float(RELIEF_ON_COLLISION_DIE);
        float after = sinceContact(sweep, vn);
        vec4 material = vec4(1.0, 1.0, 0.0, 0.0);
        if (sweep.hit.body >= 0) {
            material = materialOf(sweep.hit.body, sweep.to - after * relative - type.radius * n, n);
        }
        vec3 along = relative - vn * n;
        if (type.behaviour == float(RELIEF_ON_COLLISION_STOP)) {
            v = carried;
            contact = float(RELIEF_CONTACT_STOPPED) + 1.0 + float(sweep.hit.body);
        } else if (type.behaviour == float(RELIEF_ON_COLLISION_SLIDE)) {
            v = carried + along;
        } else {
            vec2 response = vec2(type.restitution, type.slip) * material.xy;
            response *= sweep.hit.body < 0 ? vec2(1.0) : bodyResponse(sweep.hit.body);
            v = carried + bounced(state.velocity - carried, relative, vn, along, n, type, response);
        }
        g_cost = material.z;
        writeHit(sweep, after, vn, material.w, state.contact != float(RELIEF_CONTACT_NONE), dies);
    }
    vec3 to = dies ? p : sweepEnd(sweep, carried, v, contact, type.radius);
    return State(to, v, state.collisions + 1.0, contact);
}

State moved(State state, Sweep sweep, ParticleType type, out bool dies) {
    State after = State(sweep.to, sweep.v, state.collisions, float(RELIEF_CONTACT_NONE));
    dies = false;
    if (sweep.hit.distance < 0.0) {
        after = reacted(state, sweep, type, dies);
    }
    return after;
}

// Returns the state after a step, also of a particle permanently at rest on a surface that may move. The motion of the
// surface is evaluated once for both: drivers inline every call, and compile each copy.
State moving(State state, ParticleType type, out bool dies) {
    bool rests = state.contact >= float(RELIEF_CONTACT_STOPPED);
    Sweep sweep;
    int body;
    vec3 surface;
    if (rests) {
        body = int(state.contact - float(RELIEF_CONTACT_STOPPED)) - 1;
        surface = body < 0 ? state.position : placedNow(body, state.position);
    } else {
        sweep = sweepOf(state.position, pushed(state.position, state.velocity, type), type.radius);
        body = sweep.hit.distance < 0.0 ? sweep.hit.body : -1;
        surface = sweep.to - type.radius * sweep.hit.normal;  // a ball touches at its surface
    }
    vec3 motion = body < 0 ? vec3(0.0) : motionOf(body, surface);
    State after;
    if (rests) {
        vec3 carried = body < 0 ? surface : surface + motion;
        after = State(carried, (carried - state.position) / u_dt, state.collisions, state.contact);
        dies = false;
    } else {
        sweep.hit.motion = motion;
        after = moved(state, sweep, type, dies);
    }
    return after;
}

ParticleType typeOf(vec4 birth) {
    int type = RELIEF_TYPES == 1 ? 0 : clamp(int(birth.z), 0, RELIEF_TYPES - 1);
    vec4 a = u_types[2 * type];
    vec4 b = u_types[2 * type + 1];
#if defined(RELIEF_MASKS)
    g_collides = u_collides[type];
#endif
    return ParticleType(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}

void stepAt(ivec2 texel) {
    State state = stateAt(texel);
    vec4 birth = texelFetch(u_birth, texel, 0);
    ParticleType type = typeOf(birth);
    // Compares numbers that the CPU computed, so CPU and GPU agree on the step of death. (Lifetime losses are only on the
    // GPU; the CPU frees the index at the original time of death.)
    float death = birth.y - type.loss * state.collisions;
#if defined(RELIEF_MATERIAL_LOSS)
    death -= g_lost * (birth.y - birth.x);
    bool spent = u_now >= birth.y || ((type.loss > 0.0 || g_lost > 0.0) && u_now >= death);
#else
    bool spent = u_now >= birth.y || (type.loss > 0.0 && u_now >= death);
#endif
    writeNoEvent();
    State after = state;
    bool dies = state.collisions < 0.0 || spent;
    if (dies) {
        if (state.collisions >= 0.0) {
            writeDeath(state, death);
        }
    } else {
        after = moving(state, type, dies);
#if defined(RELIEF_MATERIAL_LOSS)
        g_lost += g_cost > 0.0 ? min(g_cost / (birth.y - birth.x), 1.0) : 0.0;
#endif
    }
    if (dies) {
        writeDead();
    } else {
        writeState(state, after);
    }
}

#if !defined(RELIEF_COMPUTE)

void main() {
    stepAt(ivec2(gl_FragCoord.xy));
}

#else

layout(local_size_x = RELIEF_STEP_GROUP_WIDTH, local_size_y = RELIEF_STEP_GROUP_HEIGHT) in;
layout(rgba32f, binding = 0) writeonly uniform highp image2D u_position_out;
layout(rgba32f, binding = 1) writeonly uniform highp image2D u_velocity_out;
#if defined(RELIEF_EVENTS)
layout(rgba32f, binding = 2) writeonly uniform highp image2D u_event_velocity_out;
layout(rgba32f, binding = 3) writeonly uniform highp image2D u_event_surface_out;
#endif
uniform ivec2 u_size;  // size of the area with particles

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
#if defined(RELIEF_TOUR)
    reliefShare(int(gl_LocalInvocationIndex), RELIEF_STEP_GROUP_WIDTH * RELIEF_STEP_GROUP_HEIGHT);
#endif
    if (texel.x < u_size.x && texel.y < u_size.y) {
        stepAt(texel);
        imageStore(u_position_out, texel, o_position);
        imageStore(u_velocity_out, texel, o_velocity);
#if defined(RELIEF_EVENTS)
        imageStore(u_event_velocity_out, texel, o_event_velocity);
        imageStore(u_event_surface_out, texel, o_event_surface);
#endif
    }
}

#endif
