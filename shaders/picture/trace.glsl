// SPDX-License-Identifier: Apache-2.0
// Traces rays through the collider's combined field, in steps of about a texel, to the first change of sign. A ray
// longer than u_steps_max steps uses longer steps, so that each ray reaches its end.
//
//     origin ··|····o o o o o x───── inside        the box clips the ray; o outside, x the first inside;
//              └ bounds       ^ bisection           then ten bisections between the last two
//
// Two passes: with RELIEF_COARSE, every fourth ray of every fourth row is traced through the whole box, only for its
// distance. The second pass then starts slightly before the nearest of the nine surrounding distances, and skips rays
// where all nine missed.
//!include collider/collider.glsl
//!include picture/light.glsl

uniform float u_step;     // object units
uniform int u_steps_max;  // samples of the field per ray
uniform int u_bisections;

// Returns the step of a ray between t.x and t.y, in lengths of d, with some steps left for bisection and rounding.
float strideOf(vec3 d, vec2 t) {
    return max(u_step / length(d), (t.y - t.x) / float(u_steps_max - u_bisections - 4));
}

// Returns the first point of the collider on the ray origin + t d between t.x and t.y; -1 if there is none, -2 if t.x
// is inside.
float hit(vec3 origin, vec3 d, vec2 t) {
    float stride = strideOf(d, t);
    float outer = t.x;   // last point known to be outside
    float inner = -1.0;  // first point known to be inside, once found
    int left = u_bisections;
    float at = t.x;
    for (int i = 0; i < u_steps_max && left > 0; ++i) {
        ReliefField field = reliefSolid(origin + at * d);
        bool inside = reliefInside(field);
        if (inner < 0.0) {
            if (inside && i == 0) {
                return -2.0;
            }
            if (!inside && at >= t.y) {
                return -1.0;
            }
        } else {
            --left;
        }
        inner = inside ? at : inner;
        outer = inside ? outer : at;
        at = inner < 0.0 ? nextTest(field, origin, d, at, stride, t.y) : 0.5 * (outer + inner);
    }
    return inner;
}

#if !defined(RELIEF_COARSE)

uniform highp sampler2D u_coarse;  // result of the first pass: distance along each ray, in lengths of d; -1: no hit

// Returns the first hit, guided by the coarse pass; -1 if there is none. uv: position of the ray in the picture.
float guidedHit(vec2 uv, vec3 origin, vec3 d, vec2 span) {
    ivec2 size = textureSize(u_coarse, 0);
    ivec2 center = ivec2(uv * vec2(size));
    float nearest = 1e30;
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            float t = texelFetch(u_coarse, clamp(center + ivec2(x, y), ivec2(0), size - 1), 0).r;
            nearest = t >= 0.0 ? min(nearest, t) : nearest;
        }
    }
    if (nearest == 1e30) {
        return -1.0;
    }
    float start = max(nearest - 8.0 * strideOf(d, span), span.x);
    float t = -2.0;
    // Retry from the box if the start is inside: the guide was too deep, or the eye is in the collider.
    for (int attempt = 0; attempt < u_bisections && t == -2.0; ++attempt) {
        t = hit(origin, d, vec2(start, span.y));
        if (start == span.x) {
            break;
        }
        start = span.x;
    }
    return t == -2.0 ? span.x : t;
}

#endif
