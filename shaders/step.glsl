// One step of the simulation: age, forces, collision reaction, Euler. A fragment is a particle. The file that
// includes this one says what is solid, through solid().
//
//     position texture   x y z   object space
//                        w       collisions so far, each step in contact counting; -1 once dead
//     velocity texture   x y z   object units a second
//                        w       what the last step did: 0 free flight, 1 collided, 2 caught and pushed out
//     birth texture      x       time of birth   } seconds on the clock of u_now
//                        y       time of death   }
//                        z       type
//                        w       id modulo 2^24

uniform highp sampler2D u_position;
uniform highp sampler2D u_velocity;
uniform highp sampler2D u_birth;

uniform float u_now;      // the clock at the end of this step
uniform float u_dt;       // seconds
uniform vec3 u_gain;      // dt (gravity + drag wind)
uniform float u_keep;     // 1 / (1 + dt drag)
uniform float u_restitution;
uniform float u_slide;    // 1 - friction
uniform float u_friction_threshold;
uniform float u_ground;   // height of the floor; far below everything if there is none

layout(location = 0) out vec4 o_position;
layout(location = 1) out vec4 o_velocity;

// A point is inside where distance is negative; then normal is the way out, and map the depth map that says so.
struct Solid {
    float distance;
    vec3 normal;
    int map;
};

Solid solid(vec3 p);
// The sign alone, for a point near one where `map` decided.
bool solidAt(vec3 p, int map);

// Union of a body with the floor y < u_ground. Inside both, the deeper one decides.
Solid withGround(Solid body, vec3 p) {
    float above = p.y - u_ground;
    if (above < body.distance) {
        return Solid(above, vec3(0.0, 1.0, 0.0), body.map);
    }
    return body;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 position = texelFetch(u_position, texel, 0);
    vec4 velocity = texelFetch(u_velocity, texel, 0);
    vec4 birth = texelFetch(u_birth, texel, 0);

    // Dead, and out of sight. A comparison alone, of numbers that the CPU made: both agree on the step.
    if (position.w < 0.0 || u_now >= birth.y) {
        o_position = vec4(0.0, -1e30, 0.0, -1.0);
        o_velocity = vec4(0.0);
        return;
    }

    // Forces. Drag is integrated implicitly, v' = v + dt (g + k (w - v')): it approaches the wind for any dt,
    // while the explicit form overshoots for dt k > 1 and grows without bound for dt k > 2.
    vec3 p = position.xyz;
    vec3 v = (velocity.xyz + u_gain) * u_keep;
    vec3 p_next = p + u_dt * v;
    float contact = 0.0;

    // Reaction (paper, section 3.3.2), with v split along the normal n where the step would end:
    //
    //      p o                    o p_next           p o      ^ p_next      caught: p is inside already.
    //         \   |  outside     /                  ----\----/---------    Never pushed inwards; what points
    //      ----\--+-------------/----                    \  /              inwards is turned round.
    //           v p + dt v     about to collide
    Solid next = withGround(solid(p_next), p_next);
    if (next.distance < 0.0) {
        vec3 n = next.normal;
        float vn = dot(v, n);
        if (p.y - u_ground < 0.0 || solidAt(p, next.map)) {
            contact = 2.0;
            if (vn < 0.0) {
                v -= (2.0 * vn) * n;
            }
        } else {
            contact = 1.0;
            vec3 along = v - vn * n;
            float slide = dot(v, v) >= u_friction_threshold * u_friction_threshold ? u_slide : 1.0;
            // Where the texels of a collider meet in a step, v may enter it and still head outwards: the
            // magnitude keeps the bounce from driving it in.
            v = slide * along + (u_restitution * abs(vn)) * n;
        }
        p_next = p + u_dt * v;
    }
    o_position = vec4(p_next, position.w + (contact == 0.0 ? 0.0 : 1.0));
    o_velocity = vec4(v, contact);
}
