// SPDX-License-Identifier: Apache-2.0
// The light that a particle receives near the collider, looked up in the textures of runtime/picture/collider_light.h:
// the collider seen from the sun, and the visible fraction of the sky at each point. Does not use the collider's own
// maps.
//!include picture/sky.glsl

uniform highp sampler2D u_sun_map;    // distance of the collider from the map's plane; RELIEF_NO_SHADE: no surface
uniform highp sampler3D u_sky_fraction;  // 0…1
uniform vec4 u_sun_rows[3];           // object space to texels of the map, and to the distance from its plane
uniform float u_sun_bias;             // object units: surfaces closer to the point than this do not shade it
uniform float u_sun_cone;             // texels that the sun's disc covers at distance 1
uniform vec3 u_sky_shift;             // object space to 0…1 of u_sky_fraction: scale · (p - shift)
uniform vec3 u_sky_scale;

const vec2 GOLDEN = vec2(-0.73736888, -0.67549029);  // cosine and sine of the golden angle between samples

struct ParticleLight {
    float sun;  // visible fraction of the sun's disc
    float sky;  // visible fraction of the sky
};

// The cone from p to the sun's disc, cut by the surfaces of the map in it:
//
//         \  disc  /       A texel nearer to the sun than p shades it if its offset is within the cone at its distance;
//          \  ▓▓▓▓/▓▓▓     otherwise it is outside the cone, so slopes do not shade themselves. The shaded fraction
//           \ ^  /  map    is the weight of the shading texels among all texels in the cone. Open texels count as if
//            \| /          they were at the distance of the nearest shading texel, because their rays must pass it.
//             p
//
// `turn` and `jitter`, 0…1, vary between particles and average out the error of using few texels.
float sunFraction(vec3 p, float turn, float jitter) {
    vec2 at = vec2(dot(u_sun_rows[0], vec4(p, 1.0)), dot(u_sun_rows[1], vec4(p, 1.0)));
    float depth = dot(u_sun_rows[2], vec4(p, 1.0));
    int side = textureSize(u_sun_map, 0).x;
    float reach = u_sun_cone * depth;
    if (depth <= 0.0 || any(lessThan(at, vec2(-reach))) || any(greaterThan(at, vec2(float(side) + reach)))) {
        return 1.0;
    }
    float aside[RELIEF_SUN_SAMPLES];
    float open[RELIEF_SUN_SAMPLES];  // weights of texels that do not shade
    float hidden = 0.0;
    float nearest = RELIEF_NO_SHADE;  // nearest shading texel
    vec2 way = vec2(cos(TWO_PI * turn), sin(TWO_PI * turn));
    for (int i = 0; i < RELIEF_SUN_SAMPLES; ++i) {
        // Denser towards the centre, where surfaces near p cast their shadows.
        float u = i == 0 ? 0.0 : (float(i) + jitter - 0.5) / float(RELIEF_SUN_SAMPLES - 1);
        uvec2 texel = uvec2(ivec2(floor(at + (reach * u * u) * way)));
        bool known = all(lessThan(texel, uvec2(side)));  // negative values wrap to huge ones
        float behind = known ? depth - texelFetch(u_sun_map, ivec2(texel), 0).r : 0.0;
        float weight = max(u * u * u, 1e-4);  // of a ring
        aside[i] = reach * u * u;
        open[i] = behind > u_sun_bias ? 0.0 : weight;
        bool shades = behind > u_sun_bias && aside[i] <= u_sun_cone * behind;
        hidden += shades ? weight : 0.0;
        nearest = shades ? min(nearest, behind) : nearest;
        way = vec2(GOLDEN.x * way.x - GOLDEN.y * way.y, GOLDEN.y * way.x + GOLDEN.x * way.y);
    }
    if (hidden == 0.0) {
        return 1.0;
    }
    float seen = 0.0;
    for (int i = 0; i < RELIEF_SUN_SAMPLES; ++i) {
        seen += aside[i] <= u_sun_cone * nearest ? open[i] : 0.0;
    }
    return seen / (seen + hidden);
}

ParticleLight particleLight(vec3 p, float turn, float jitter) {
    return ParticleLight(sunFraction(p, turn, jitter), textureLod(u_sky_fraction, u_sky_scale * (p - u_sky_shift), 0.0).r);
}
