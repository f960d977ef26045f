// One step of the simulation: age, forces, collision reaction, Euler or Verlet. A fragment is a particle. The file
// that includes this one says what is solid.
//
//     position texture   x y z   world space
//                        w       collisions so far, each step in contact counting; -1 once dead
//     velocity texture   x y z   world units a second
//                        w       what the last step did: 0 free flight, 1 collided, 2 caught and pushed out;
//                                3 at rest for good on the floor, 4 + b on body b
//     birth texture      x       time of birth   } seconds on the clock of u_now
//                        y       time of death   }
//                        z       type
//                        w       id modulo 2^24
//
// With RELIEF_VERLET there is no velocity texture: the velocity is the way from the position before, and the
// position's w holds both counts, collisions + (what the last step did) / 16.

uniform highp sampler2D u_position;
#if defined(RELIEF_VERLET)
uniform highp sampler2D u_position_before;
uniform float u_rate_before;  // 1 / seconds of the last step
#else
uniform highp sampler2D u_velocity;
#endif
uniform highp sampler2D u_birth;

uniform float u_now;      // the clock at the end of this step
uniform float u_dt;       // seconds
uniform vec3 u_gravity;   // world units a second squared
uniform vec3 u_wind;      // velocity of the air, world units a second
uniform float u_still;    // at or below this speed what is in contact rests: a thousandth of what gravity gives in a step
#if defined(RELIEF_HAS_AIR)
uniform float u_air_time; // seconds, as airTime() gives them
#endif
uniform float u_ground;   // height of the floor; far below everything if there is none
#if defined(RELIEF_SWEEP)
uniform float u_sweep;    // the longest way between two tests, world units
#endif

// Of each type: radius; restitution; 1 - friction; speed below which there is no friction / drag, 1/s; what a
// collision does; seconds of life that a collision costs.
uniform vec4 u_types[2 * RELIEF_TYPES];
const float RELIEF_BOUNCE = 0.0;
const float RELIEF_STOP = 1.0;
const float RELIEF_SLIDE = 2.0;
const float RELIEF_DIE = 3.0;

#if defined(RELIEF_VERLET)
layout(location = 0) out vec4 o_position;
#else
layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_velocity;
#endif

// A point is inside where distance is negative; then normal is the way out, map the depth map that says so, and body
// the body: -1 the floor.
struct Solid {
    float distance;
    vec3 normal;
    int map;
    int body;
#if RELIEF_LIVE
    vec3 motion;  // where inside a live body: the way of its surface in this step, in its object space; or zero
#endif
};

#if RELIEF_LIVE
#define RELIEF_SOLID(distance, normal, map, body, motion) Solid(distance, normal, map, body, motion)
#else
#define RELIEF_SOLID(distance, normal, map, body, motion) Solid(distance, normal, map, body)
#endif

// Of everything but the floor, at the end of the step; what a ball about p touches.
Solid solid(vec3 p, float radius);
// Whether p, where the step began, was inside the body of s at that time.
bool insideBefore(vec3 p, float radius, Solid s);
// Where a point of a body was at the beginning of the step, and where one of then is at its end; and restitution and
// 1 - friction of a body, factors of the particle's own. Without poses nothing moves.
#if RELIEF_BODIES == 0
vec3 pointBefore(int body, vec3 p) {
    return p;
}

vec3 pointNow(int body, vec3 p) {
    return p;
}

vec2 bodyResponse(int body) {
    return vec2(1.0);
}
#else
#if RELIEF_LIVE
vec3 pointBefore(Solid s, vec3 p);
#else
vec3 pointBefore(int body, vec3 p);
#endif
vec3 pointNow(int body, vec3 p);
vec2 bodyResponse(int body);
#endif

// Union with the floor y < u_ground. Inside both, the deeper one decides.
Solid solidOrGround(vec3 p, float radius) {
    Solid deepest = solid(p, radius);
    float above = p.y - radius - u_ground;
    if (above < deepest.distance) {
        deepest = RELIEF_SOLID(above, vec3(0.0, 1.0, 0.0), -1, -1, vec3(0.0));
    }
    return deepest;
}

bool caught(vec3 p, float radius, Solid s) {
    return s.body < 0 ? p.y - radius < u_ground : insideBefore(p, radius, s);
}

vec3 surfaceVelocity(Solid s, vec3 p) {
#if RELIEF_LIVE
    return s.body < 0 ? vec3(0.0) : (p - pointBefore(s, p)) / u_dt;
#else
    return s.body < 0 ? vec3(0.0) : (p - pointBefore(s.body, p)) / u_dt;
#endif
}

void finish(vec3 p, vec3 v, float collisions, float contact) {
#if defined(RELIEF_VERLET)
    // Beyond 2^19 a float would lose the sixteenths.
    o_position = vec4(p, min(collisions, 524287.0) + contact / 16.0);
#else
    o_position = vec4(p, collisions);
    o_velocity = vec4(v, contact);
#endif
}

#if defined(RELIEF_SWEEP) && defined(RELIEF_VERLET)
// The velocity of Verlet is the way of the last step, so after a reaction the whole way must be gone, and tested: from
// p, where the surface has carried the particle, with the velocity relative to it, up to the first piece that would
// end inside. What is not free yet may first come out.
vec3 sweptWay(vec3 p, vec3 v, bool free, float radius) {
    float pieces = clamp(ceil(u_dt * length(v) / u_sweep), 1.0, float(RELIEF_SWEEP));
    vec3 reached = p;
    for (int i = 1; i <= RELIEF_SWEEP && float(i) <= pieces; ++i) {
        vec3 q = p + (float(i) / pieces * u_dt) * v;
        bool inside = solidOrGround(q, radius).distance < 0.0;
        if (inside && free) {
            break;
        }
        free = free || !inside;
        reached = q;
    }
    return reached;
}
#endif

// Dead, and out of sight.
void finishDead() {
    o_position = vec4(0.0, -1e30, 0.0, -1.0);
#if !defined(RELIEF_VERLET)
    o_velocity = vec4(0.0);
#endif
}

// At rest for good, on something that may move.
void rest(vec3 p, float collisions, float contact) {
    int body = int(contact) - 4;
    vec3 carried = p;
    if (body >= 0) {
        carried = pointNow(body, p);
    }
    finish(carried, (carried - p) / u_dt, collisions, contact);
}

void move(vec3 p, vec3 v, float collisions, vec4 type_a, vec4 type_b) {
    // Forces. Drag is integrated implicitly, v' = v + dt (g + k (w - v')): it approaches the wind for any dt,
    // while the explicit form overshoots for dt k > 1 and grows without bound for dt k > 2.
    vec3 v_begin = v;
    vec3 acceleration = u_gravity;
    vec3 air = u_wind;
#if defined(RELIEF_HAS_AIR)
    acceleration += fieldAcceleration(p, v, u_air_time);
    air += airVelocity(p, u_air_time);
#endif
    v = (v + u_dt * (acceleration + type_b.x * air)) * (1.0 / (1.0 + u_dt * type_b.x));

    // Reaction (paper, section 3.3.2), with v split along the normal n where the step would end:
    //
    //      p o                    o p_next           p o      ^ p_next      caught: p is inside already.
    //         \   |  outside     /                  ----\----/---------    Never pushed inwards; what points
    //      ----\--+-------------/----                    \  /              inwards is turned round.
    //           v p + dt v     about to collide
    vec3 from = p;       // the last point of the way that is known to be free
    float share = 1.0;   // of the step, from there to where it would end
#if defined(RELIEF_SWEEP)
    // The way in pieces no longer than u_sweep; what is faster than that allows is slowed down.
    float way = u_dt * length(v);
    float longest = float(RELIEF_SWEEP) * u_sweep;
    if (way > longest) {
        v *= longest / way;
        way = longest;
    }
    float pieces = max(ceil(way / u_sweep), 1.0);
    share = 1.0 / pieces;
    vec3 p_next = p + (share * u_dt) * v;
    Solid next = solidOrGround(p_next, type_a.x);
    for (int i = 1; i < RELIEF_SWEEP && float(i) < pieces && next.distance >= 0.0; ++i) {
        from = p_next;
        p_next = p + ((float(i) + 1.0) * share * u_dt) * v;
        next = solidOrGround(p_next, type_a.x);
    }
    bool first_piece = from == p;
#else
    vec3 p_next = p + u_dt * v;
    Solid next = solidOrGround(p_next, type_a.x);
    const bool first_piece = true;
#endif
    bool dies = false;
    float contact = 0.0;
    if (next.distance < 0.0) {
        vec3 n = next.normal;
        vec3 carried = surfaceVelocity(next, p_next);
        vec3 relative = v - carried;
        float vn = dot(relative, n);
#if defined(RELIEF_SWEEP)
        // All pieces are tested against the end of the step: what met a moving body in its first has yet to be
        // carried for the rest of it.
        vec3 carried_to = first_piece ? p + u_dt * carried : from;
        from += first_piece ? ((1.0 - share) * u_dt) * carried : vec3(0.0);
#endif
        if (first_piece && caught(p, type_a.x, next)) {
            contact = 2.0;
            if (vn < 0.0) {
                v -= (2.0 * vn) * n;
            }
            p_next = from + (share * u_dt) * v;
        } else {
            dies = type_b.y == RELIEF_DIE;
            vec2 response = vec2(type_a.y, type_a.z) * (next.body < 0 ? vec2(1.0) : bodyResponse(next.body));
            contact = 1.0;
            vec3 along = relative - vn * n;
            if (type_b.y == RELIEF_STOP) {
                v = carried;
                contact = 4.0 + float(next.body);
            } else if (type_b.y == RELIEF_SLIDE) {
                v = carried + along;
            } else {
                float slide = dot(relative, relative) >= type_a.w * type_a.w ? response.y : 1.0;
                // The particle stays at p, above what it would have met, so the speed that it had there comes back
                // and not what this step's forces would add on the way: so no bounce adds energy, and bounces end.
                // (Where texels meet in a step, v may enter the collider and still head outwards: no bounce.)
                float arrives = min(max(-dot(v_begin - carried, n), 0.0), abs(vn));
                vec3 left = slide * along + (response.x * arrives) * n;
                // A thousandth of what gravity gives in a step is rounding, and would creep.
                left = dot(left, left) > u_still * u_still ? left : vec3(0.0);
                v = carried + left;
            }
            p_next = from + (share * u_dt) * v;
#if defined(RELIEF_SWEEP)
            // What was outside stays outside, whatever lies beside.
            if (solidOrGround(p_next, type_a.x).distance < 0.0) {
                p_next = carried_to;
            }
#endif
        }
#if defined(RELIEF_SWEEP) && defined(RELIEF_VERLET)
        if (contact < 3.0) {
            p_next = sweptWay(p + u_dt * carried, v - carried, contact == 1.0, type_a.x);
        }
#endif
        collisions += 1.0;
    }
    if (dies) {
        finishDead();
    } else {
        finish(p_next, v, collisions, contact);
    }
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(u_position, texel, 0);
    vec4 birth = texelFetch(u_birth, texel, 0);
    vec3 p = position.xyz;
#if defined(RELIEF_VERLET)
    vec3 v = (p - texelFetch(u_position_before, texel, 0).xyz) * u_rate_before;
    float collisions = floor(position.w);
    float contact = (position.w - collisions) * 16.0;
#else
    vec4 velocity = texelFetch(u_velocity, texel, 0);
    vec3 v = velocity.xyz;
    float collisions = position.w;
    float contact = velocity.w;
#endif
    int type = RELIEF_TYPES == 1 ? 0 : clamp(int(birth.z), 0, RELIEF_TYPES - 1);
    vec4 type_a = u_types[2 * type];      // radius, restitution, 1 - friction, threshold
    vec4 type_b = u_types[2 * type + 1];  // drag, behaviour, loss

    // A comparison alone, of numbers that the CPU made: both agree on the step. (A loss of life only the GPU knows;
    // the CPU then frees the index at the time that it was born with.)
    if (position.w < 0.0 || u_now >= birth.y || (type_b.z > 0.0 && u_now >= birth.y - type_b.z * collisions)) {
        finishDead();
    } else if (contact >= 3.0) {
        rest(p, collisions, contact);
    } else {
        move(p, v, collisions, type_a, type_b);
    }
}
