// What a sprite paints over a pixel.
//!include grain.glsl
//!include grain_light.glsl
//!include srgb.glsl

uniform float u_soft;             // object units; 0: hard edges
uniform vec2 u_depth;             // window depth of view distance t: x + y / t
uniform bool u_srgb;              // the target holds sRGB values

// A round grain, by the share of its radius: its edge is a smooth step.
float roundAt(float radius, float per_edge) {
    float inside = clamp((1.0 - radius) * per_edge, 0.0, 1.0);
    return inside * inside * (3.0 - 2.0 * inside);
}

float distanceOf(float depth) {
    return u_depth.y / (depth - u_depth.x);
}

// How much of a sprite at a window depth is left before what lies `behind`. A sprite lies where its front is.
float softShare(float behind, float depth) {
    return clamp((distanceOf(behind) - distanceOf(depth)) / u_soft, 0.0, 1.0);
}

// Colour times alpha, and alpha, at a place of the sprite, -1…1; alpha 0 where nothing is seen.
// `body`: what the sprite is there, premultiplied; `shown`: how much of it.
vec4 paintOf(Grain grain, vec2 at, float radius, vec4 body, float shown) {
    float alpha = shown * body.a;
    if (alpha <= 0.003) {
        return vec4(0.0);
    }
    vec3 light = vec3(1.0);
    if (grain.lit) {
        light = grainLight(vec3(at, sqrt(max(1.0 - radius * radius, 0.0))), grain.sun, grain.sky);
    }
    vec4 color = vec4(grain.color * light * (shown * body.rgb), alpha);
    if (u_srgb) {
        color.rgb = alpha * srgbOf(min(color.rgb / alpha, vec3(1.0)));
    }
    return color;
}
