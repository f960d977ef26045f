// SPDX-License-Identifier: Apache-2.0
// The light at a point near collider and floor: a sun with a disc, and a sky, both occluded along rays by the
// collider's field. Used for the picture of the collider, which is cached; particles look up the same light
// (particle_light.glsl). Needs collider.glsl.
//!include picture/sky.glsl
//!include base/noise.glsl
//!include picture/ray.glsl

uniform vec3 u_bounds_min;    // of the collider, with a small margin
uniform vec3 u_bounds_max;
uniform float u_scale;        // longest side of the bounds
uniform float u_texel;        // object units of the finest texel
uniform vec3 u_sun;           // unit vector towards it

// Returns the part of a ray p + t d, t in [t_min, t_max], inside the bounds; empty if x > y.
vec2 clipToBounds(vec3 p, vec3 d, float t_min, float t_max) {
    vec3 near, far;
    slabs(p, d, u_bounds_min, u_bounds_max, near, far);
    return vec2(max(max(near.x, near.y), max(near.z, t_min)), min(min(far.x, far.y), min(far.z, t_max)));
}

bool blocked(vec3 p, vec3 d, float reach, int steps, float jitter) {
    vec2 span = clipToBounds(p, d, 0.0, reach);
    if (span.x >= span.y) {
        return false;
    }
    float stride = (span.y - span.x) / float(steps);
    float next = span.x;
    for (int i = 0; i < steps; ++i) {
        float t = span.x + (float(i) + jitter) * stride;
        if (t >= next) {
            ReliefField field = reliefSolid(p + t * d);
            if (reliefInside(field)) {
                return true;
            }
            next = nextTest(field, p, d, t, 0.0, span.y);
        }
    }
    return false;
}

// Returns two unit vectors that form an orthonormal basis with n (Duff et al., JCGT 2017).
void basis(vec3 n, out vec3 a, out vec3 b) {
    float s = n.z < 0.0 ? -1.0 : 1.0;
    float u = -1.0 / (s + n.z);
    float v = n.x * n.y * u;
    a = vec3(1.0 + s * n.x * n.x * u, s * v, -s * n.x);
    b = vec3(v, s + n.y * n.y * u, -n.y);
}

// Returns the light on a surface with normal n at p: `sun`, the visible fraction of the sun's disc, and `sky`, the
// light of sky and floor, by cosine-weighted rays of limited length. All rays run through one loop whose bounds are
// unknown to the compiler: otherwise drivers that inline and unroll would compile the field dozens of times.
uniform ivec2 u_rays;       // towards the sun, towards the sky; at least 1 each
uniform ivec2 u_ray_steps;  // samples of the field per ray

void receive(vec3 p, vec3 n, inout uint seed, out float sun, out vec3 sky) {
    float turn = noise(seed);
    sun = 0.0;
    sky = vec3(0.0);
    for (int i = 0; i < u_rays.x + u_rays.y; ++i) {
        bool to_sun = i < u_rays.x;
        int ray = to_sun ? i : i - u_rays.x;
        float r2 = (float(ray) + noise(seed)) / float(to_sun ? u_rays.x : u_rays.y);
        float angle = TWO_PI * (turn + 0.618034 * float(ray));
        vec3 axis = to_sun ? u_sun : n;
        vec3 a, b;
        basis(axis, a, b);
        vec3 across = sqrt(r2) * (cos(angle) * a + sin(angle) * b);
        vec3 d = to_sun ? normalize(axis + RELIEF_SUN_WIDTH * across) : across + sqrt(1.0 - r2) * axis;
        bool hidden = blocked(p, d, (to_sun ? 4.0 : RELIEF_SKY_REACH) * u_scale, to_sun ? u_ray_steps.x : u_ray_steps.y, noise(seed));
        if (to_sun) {
            sun += hidden ? 0.0 : 1.0;
        } else {
            sky += (hidden ? SKY_HIDDEN : 1.0) * mix(FLOOR_COLOR, SKY_COLOR, 0.5 + 0.5 * d.y);
        }
    }
    sun /= float(u_rays.x);
    sky /= float(u_rays.y);
}
