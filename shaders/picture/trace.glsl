// SPDX-License-Identifier: Apache-2.0
// Rays through the collider's combined field, in steps of about a texel, to the first change of sign. A ray that is longer than
// u_steps_max of these takes longer ones, so that each reaches its end.
//
//     origin ··|····o o o o o x───── inside        the box clips the ray; o outside, x the first inside;
//              └ bounds       ^ bisection           then ten bisections between the last two
//
// Two passes. With RELIEF_COARSE every fourth ray of every fourth row is followed through the whole box, for its distance
// alone; the second pass then starts a little before the nearest of the nine distances around it, and follows no ray where
// all nine missed.
//!include collider/collider.glsl
//!include picture/light.glsl

uniform float u_step;     // object units
uniform int u_steps_max;  // samples of the field on a ray
uniform int u_bisections;

// In lengths of d: the step of a ray between t.x and t.y, which leaves room for the bisections and for rounding.
float strideOf(vec3 d, vec2 t) {
    return max(u_step / length(d), (t.y - t.x) / float(u_steps_max - u_bisections - 4));
}

// First point of the collider on the ray origin + t d between t.x and t.y; -1 if there is none, -2 if t.x lies inside.
float hit(vec3 origin, vec3 d, vec2 t) {
    float stride = strideOf(d, t);
    float outer = t.x;   // the last point known to be outside
    float inner = -1.0;  // the first known to be inside, once there is one
    int left = u_bisections;
    float at = t.x;
    for (int i = 0; i < u_steps_max && left > 0; ++i) {
        float next;
        bool inside = insideAt(origin, d, at, stride, t.y, next);
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
        at = inner < 0.0 ? next : 0.5 * (outer + inner);
    }
    return inner;
}

#if !defined(RELIEF_COARSE)

uniform highp sampler2D u_coarse;  // the first pass: along each ray the distance, in lengths of d; -1: missed

// The first hit with the help of the coarse pass; uv: the place of the ray in the picture. -1 if there is none.
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
    // Once more from the box if the start lies inside: the guide was too far in, or the eye is in the collider.
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
