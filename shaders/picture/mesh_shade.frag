// SPDX-License-Identifier: Apache-2.0
// Shades the meshes with sun and sky light, rain, snow and fog.
//!include picture/sky.glsl
//!include base/srgb.glsl
//!include base/noise.glsl

in vec2 v_uv;

uniform highp sampler2D u_surface_color;   // sRGB; a: how much snow stays there
uniform highp sampler2D u_surface_normal;  // w: 0 for no surface
uniform highp sampler2D u_surface_depth;
uniform highp sampler2D u_sun_depth;
uniform highp sampler2D u_zenith_depth;
uniform highp sampler2D u_prints;  // in the projection of the zenith map

uniform vec3 u_eye;
uniform vec3 u_forward;  // the pixel's ray is eye + t (forward + x right + y up), t = distance along forward
uniform vec3 u_right;
uniform vec3 u_up;
uniform vec2 u_depth;  // window depth of view distance t: x + y / t
uniform mat4 u_clip;   // world to the picture's clip space
uniform mat4 u_sun_clip;
uniform mat4 u_zenith_clip;
uniform vec3 u_sun;         // unit vector towards it
uniform vec3 u_background;  // linear
uniform float u_sunlight;   // 0…1
uniform float u_per_fog;    // 1 / world units
uniform float u_wet;
uniform float u_snow;
uniform float u_meter;      // world units
uniform bool u_srgb;

layout(location = 0) out vec4 o_color;

const vec3 CLEAR_SKY = vec3(0.13, 0.30, 0.62);
const vec3 SNOW_COLOR = vec3(0.84, 0.87, 0.92);
const int SUN_TAPS = 8;
const int CORNER_TAPS = 12;

float latticeNoise(ivec3 at) {
    uint seed = uint(at.x) * 0x8da6b343u ^ uint(at.y) * 0xd8163841u ^ uint(at.z) * 0xcb1ab31fu;
    return noise(seed);
}

// Value noise, 0…1.
float smoothNoise(vec3 p) {
    vec3 low = floor(p);
    vec3 t = p - low;
    t = t * t * (3.0 - 2.0 * t);
    ivec3 at = ivec3(low);
    vec4 near = vec4(latticeNoise(at), latticeNoise(at + ivec3(1, 0, 0)), latticeNoise(at + ivec3(0, 1, 0)),
                     latticeNoise(at + ivec3(1, 1, 0)));
    vec4 far = vec4(latticeNoise(at + ivec3(0, 0, 1)), latticeNoise(at + ivec3(1, 0, 1)),
                    latticeNoise(at + ivec3(0, 1, 1)), latticeNoise(at + ivec3(1, 1, 1)));
    vec4 both = mix(near, far, t.z);
    vec2 row = mix(both.xz, both.yw, t.x);
    return mix(row.x, row.y, t.y);
}

float fractalNoise(vec3 p) {
    return 0.55 * smoothNoise(p) + 0.3 * smoothNoise(2.1 * p + 7.3) + 0.15 * smoothNoise(4.3 * p + 1.7);
}

// Returns the fraction of a disc around p, with a world-space radius, that is unoccluded in a parallel map; 1 outside
// the map.
float openFraction(highp sampler2D map, mat4 clip, vec3 p, float radius, float bias, inout uint seed) {
    vec3 at = 0.5 * (clip * vec4(p, 1.0)).xyz + 0.5;
    vec2 reach = (0.5 * radius) * vec2(length(vec3(clip[0].x, clip[1].x, clip[2].x)), length(vec3(clip[0].y, clip[1].y, clip[2].y)));
    float depth_bias = 0.5 * bias * length(vec3(clip[0].z, clip[1].z, clip[2].z));
    float turn = TWO_PI * noise(seed);
    float open = 0.0;
    for (int i = 0; i < SUN_TAPS; ++i) {
        float angle = turn + 2.399963 * float(i);
        vec2 tap = at.xy + reach * sqrt((float(i) + 0.5) / float(SUN_TAPS)) * vec2(cos(angle), sin(angle));
        bool known = all(greaterThanEqual(tap, vec2(0.0))) && all(lessThan(tap, vec2(1.0)));
        float nearest = textureLod(map, tap, 0.0).r;
        open += known && nearest < 1.0 && nearest < at.z - depth_bias ? 0.0 : 1.0;
    }
    return open / float(SUN_TAPS);
}

vec3 skyColor(vec3 d) {
    vec3 zenith = mix(0.62 * u_background, CLEAR_SKY, 0.75 * u_sunlight);
    return mix(1.05 * u_background, zenith, smoothstep(0.0, 0.6, d.y));
}

// Returns the fraction of the sky that nearby surfaces leave visible, from the picture's own depths: rays around the
// normal count as unoccluded if their end is in front of the surface visible there.
float cornerFraction(vec3 p, vec3 n, float t, inout uint seed) {
    float open = 0.0;
    float turn = noise(seed);
    for (int i = 0; i < CORNER_TAPS; ++i) {
        float z = 1.0 - 2.0 * (float(i) + noise(seed)) / float(CORNER_TAPS);
        float angle = TWO_PI * (turn + 0.618034 * float(i));
        vec3 way = normalize(n + 0.99 * vec3(sqrt(1.0 - z * z) * vec2(cos(angle), sin(angle)), z));
        float share = (float(i) + 0.5) / float(CORNER_TAPS);
        float reach = u_meter * mix(0.04, 1.2, share * share);
        vec3 end = p + reach * way;
        vec4 clip = u_clip * vec4(end, 1.0);
        vec2 at = 0.5 * clip.xy / clip.w + 0.5;
        float window = textureLod(u_surface_depth, at, 0.0).r;
        float seen = u_depth.y / (window - u_depth.x);
        float behind = clip.w - seen;
        bool hidden = clip.w > 0.0 && behind > 0.01 * reach + 0.0005 * t && behind < 3.0 * reach + 0.3 * u_meter;
        open += hidden ? 0.0 : 1.0;
    }
    return open / float(CORNER_TAPS);
}

void main() {
    uint seed = uint(gl_FragCoord.x) * 1973u + uint(gl_FragCoord.y) * 9277u + 26699u;
    noise(seed);
    vec2 corner = 2.0 * v_uv - 1.0;
    vec3 ray = u_forward + corner.x * u_right + corner.y * u_up;
    vec3 d = normalize(ray);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float window = texelFetch(u_surface_depth, pixel, 0).r;
    vec3 color = skyColor(d);
    if (window < 1.0) {
        float t = u_depth.y / (window - u_depth.x);
        vec3 p = u_eye + t * ray;
        vec3 given = texelFetch(u_surface_normal, pixel, 0).xyz;
        vec3 n = dot(given, given) > 1e-12 ? normalize(given) : -d;
        vec4 surface = texelFetch(u_surface_color, pixel, 0);
        vec3 albedo = linearOf(surface.rgb);
        vec3 q = p / u_meter;
        float grain = fractalNoise(1.7 * q);
        albedo *= 0.86 + 0.28 * grain;

        float shelter = openFraction(u_zenith_depth, u_zenith_clip, p + (0.03 * u_meter) * n, 0.25 * u_meter, 0.05 * u_meter, seed);
        vec2 on_map = 0.5 * (u_zenith_clip * vec4(p, 1.0)).xy + 0.5;
        float on_it = all(greaterThanEqual(on_map, vec2(0.0))) && all(lessThan(on_map, vec2(1.0))) ? 1.0 : 0.0;
        float texel = 1.0 / float(textureSize(u_prints, 0).x);
        vec2 slope = vec2(0.0);
        float pressed = 0.0;
        for (int i = 0; i < 9; ++i) {
            vec2 off = vec2(float(i % 3 - 1), float(i / 3 - 1));
            float there = on_it * textureLod(u_prints, on_map + 1.5 * texel * off, 0.0).r;
            pressed += there / 9.0;
            slope += (there / 6.0) * off;
        }

        // Snow collects on level surfaces, first on rough spots.
        float level = n.y + 0.25 * (grain - 0.5);
        float rough = 0.25 + 0.75 * fractalNoise(0.45 * q + 3.1);
        float lies = u_snow > 0.0 ? smoothstep(1.0 - u_snow - 0.12, 1.0 - u_snow + 0.12, rough) : 0.0;
        lies = mix(lies, u_snow, u_snow * u_snow);
        float cover = shelter * smoothstep(0.35, 0.62, level) * lies * surface.a;
        float print = pressed * smoothstep(0.15, 0.4, cover);
        albedo = mix(albedo, SNOW_COLOR * mix(0.95, 1.0, grain), cover * (1.0 - 0.7 * print));
        vec3 shaded = normalize(n + cover * vec3(2.4 * slope.x, 0.0, -2.4 * slope.y));

        float wet = u_wet * shelter * (1.0 - cover);
        albedo *= mix(1.0, 0.68, wet);

        float facing = dot(shaded, u_sun);
        float sun = facing > 0.0 && u_sunlight > 0.0 ? openFraction(u_sun_depth, u_sun_clip, p + (0.02 * u_meter) * n, 0.05 * u_meter, u_meter * (0.03 + 0.05 * (1.0 - facing)), seed) : 0.0;
        float overhead = openFraction(u_zenith_depth, u_zenith_clip, p + (0.1 * u_meter) * n, 2.5 * u_meter, 0.3 * u_meter, seed);
        float open = cornerFraction(p + 0.002 * t * n, n, t, seed);
        open *= open;
        vec3 sky = mix(FLOOR_COLOR, SKY_COLOR, 0.5 + 0.5 * shaded.y) * mix(1.9, 1.05, u_sunlight);
        sky *= open * mix(0.45, 1.0, overhead);
        vec3 lit = albedo * (2.0 * max(facing, 0.0) * sun * u_sunlight * SUN_COLOR + sky);
        // Snow has subsurface scattering.
        lit += cover * 0.06 * SKY_COLOR * open;

        // A film of water reflects the sky, more in puddles.
        float puddle = smoothstep(0.97, 0.995, n.y) * smoothstep(0.52, 0.62, fractalNoise(0.8 * q + 11.0));
        float film = wet * mix(0.35, 1.0, puddle);
        vec3 mirrored = reflect(d, mix(n, vec3(0.0, 1.0, 0.0), puddle));
        float fresnel = 0.03 + 0.97 * pow(1.0 - clamp(dot(-d, n), 0.0, 1.0), 5.0);
        vec3 glint = u_sunlight * sun * pow(max(dot(mirrored, u_sun), 0.0), 120.0) * 3.0 * SUN_COLOR;
        lit = mix(lit, skyColor(vec3(mirrored.x, abs(mirrored.y), mirrored.z)) * mix(0.5, 1.0, overhead) + glint,
                  film * fresnel);

        // Reinhard's curve with its white at 2, so that sunlit snow keeps its shape.
        lit *= (1.0 + lit * 0.25) / (1.0 + 0.35 * lit);

        float haze = 1.0 - exp(-t * length(ray) * u_per_fog);
        color = mix(lit, u_background * 1.05, haze);
    }
    o_color = vec4(color, 1.0);
    if (u_srgb) {
        o_color.rgb = srgbOf(clamp(o_color.rgb, 0.0, 1.0));
    }
    gl_FragDepth = window;
}
