// SPDX-License-Identifier: Apache-2.0
// The state of a particle, as stored in textures.
//
//     position texture   x y z   world space
//                        w       steps in contact so far; RELIEF_DEAD_COLLISIONS once dead
//     velocity texture   x y z   world units/s
//                        w       contact in the last step (constants.h): RELIEF_CONTACT_NONE, _COLLIDED, _CAUGHT (and
//                                pushed out); permanently at rest: _STOPPED on the floor, _STOPPED + 1 + b on body b.
//                                The fractional part is the fraction of the lifetime lost to materials;
//                                RELIEF_LOST_MAX: all of it
//     birth texture      x       time of birth   } seconds on the clock of u_now
//                        y       time of death   }
//                        z       type
//                        w       id modulo 2^24
//
// With RELIEF_VERLET the velocity is the displacement of the last step over its duration. After a hit in a swept step,
// whose path ends early, it is the velocity of the reaction.
uniform highp sampler2D u_position;
uniform highp sampler2D u_velocity;
#if defined(RELIEF_VERLET)
uniform float u_rate;  // 1 / seconds of this step
#endif

// Outputs of a step: fragment colours, or variables that step.glsl stores in images (compute).
#if defined(RELIEF_COMPUTE)
#define RELIEF_STATE_OUT(i)
#else
#define RELIEF_STATE_OUT(i) layout(location = i) out
#endif
RELIEF_STATE_OUT(0) vec4 o_position;
RELIEF_STATE_OUT(1) vec4 o_velocity;

// Fraction of its lifetime that this invocation's particle has lost to materials.
#if defined(RELIEF_MATERIAL_LOSS)
float g_lost = 0.0;
#endif

struct State {
    vec3 position;
    vec3 velocity;
    float collisions;
    float contact;
};

State stateAt(ivec2 texel) {
    vec4 position = texelFetch(u_position, texel, 0);
    vec4 velocity = texelFetch(u_velocity, texel, 0);
    float contact = floor(velocity.w);
#if defined(RELIEF_MATERIAL_LOSS)
    g_lost = velocity.w - contact;
    g_lost = g_lost >= RELIEF_LOST_MAX ? 1.0 : g_lost;
#endif
    return State(position.xyz, velocity.xyz, position.w, contact);
}

// Writes the state after a step from `before`.
void writeState(State before, State after) {
#if defined(RELIEF_VERLET)
    vec3 displaced = (after.position - before.position) * u_rate;
#if defined(RELIEF_SWEEP)
    after.velocity = after.contact == float(RELIEF_CONTACT_NONE) ? displaced : after.velocity;
#else
    after.velocity = displaced;
#endif
#endif
    o_position = vec4(after.position, after.collisions);
    o_velocity = vec4(after.velocity, after.contact);
#if defined(RELIEF_MATERIAL_LOSS)
    o_velocity.w += min(g_lost, RELIEF_LOST_MAX);
#endif
}

void writeDead() {
    o_position = vec4(0.0, RELIEF_DEAD_HEIGHT, 0.0, RELIEF_DEAD_COLLISIONS);
    o_velocity = vec4(0.0);
}
