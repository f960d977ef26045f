// The state of a particle, as the textures hold it.
//
//     position texture   x y z   world space
//                        w       collisions so far, each step in contact counting; RELIEF_DEAD_COLLISIONS once dead
//     velocity texture   x y z   world units a second
//                        w       contact of the last step (constants.h): RELIEF_CONTACT_NONE, _COLLIDED, _CAUGHT (and
//                                pushed out); at rest for good _STOPPED on the floor, or more by 1 + b on body b
//     birth texture      x       time of birth   } seconds on the clock of u_now
//                        y       time of death   }
//                        z       type
//                        w       id modulo 2^24
//
// With RELIEF_VERLET there is no velocity texture. The velocity is the displacement from the position before, and the
// position's w holds both counts: collisions + contact / RELIEF_CONTACT_PARTS.
uniform highp sampler2D u_position;

// Outputs of a step: a fragment's colours, or for compute variables that step.glsl stores in images.
#if defined(RELIEF_COMPUTE)
#define RELIEF_STATE_OUT(i)
#else
#define RELIEF_STATE_OUT(i) layout(location = i) out
#endif

struct State {
    vec3 position;
    vec3 velocity;
    float collisions;
    float contact;
};

#if defined(RELIEF_VERLET)

// Locations of the events, behind the state.
#define RELIEF_EVENT_VELOCITY_OUT 1
#define RELIEF_EVENT_SURFACE_OUT 2
uniform highp sampler2D u_position_before;
uniform float u_rate_before;  // 1 / seconds of the last step

RELIEF_STATE_OUT(0) vec4 o_position;

State stateAt(ivec2 texel) {
    vec4 position = texelFetch(u_position, texel, 0);
    vec3 v = (position.xyz - texelFetch(u_position_before, texel, 0).xyz) * u_rate_before;
    float collisions = floor(position.w);
    return State(position.xyz, v, collisions, (position.w - collisions) * RELIEF_CONTACT_PARTS);
}

void writeState(vec3 p, vec3 v, float collisions, float contact) {
    o_position = vec4(p, min(collisions, RELIEF_VERLET_COLLISIONS_MAX) + contact / RELIEF_CONTACT_PARTS);
}

void writeDead() {
    o_position = vec4(0.0, RELIEF_DEAD_HEIGHT, 0.0, RELIEF_DEAD_COLLISIONS);
}

#else

#define RELIEF_EVENT_VELOCITY_OUT 2
#define RELIEF_EVENT_SURFACE_OUT 3
uniform highp sampler2D u_velocity;

RELIEF_STATE_OUT(0) vec4 o_position;
RELIEF_STATE_OUT(1) vec4 o_velocity;

State stateAt(ivec2 texel) {
    vec4 position = texelFetch(u_position, texel, 0);
    vec4 velocity = texelFetch(u_velocity, texel, 0);
    return State(position.xyz, velocity.xyz, position.w, velocity.w);
}

void writeState(vec3 p, vec3 v, float collisions, float contact) {
    o_position = vec4(p, collisions);
    o_velocity = vec4(v, contact);
}

void writeDead() {
    o_position = vec4(0.0, RELIEF_DEAD_HEIGHT, 0.0, RELIEF_DEAD_COLLISIONS);
    o_velocity = vec4(0.0);
}

#endif
