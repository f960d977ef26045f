// What each particle receives, before any is drawn: one texel a particle, so that the vertices of a sprite share it.
// x: the share of the sun's disc that it sees; yzw: the light of the sky from above.
//!include collider.glsl
//!include light.glsl
//!include look.glsl

uniform highp sampler2D u_position;
uniform highp sampler2D u_birth;
uniform int u_extent;
uniform float u_now;

layout(location = 0) out vec4 o_light;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    int index = texel.y * textureSize(u_position, 0).x + texel.x;
    vec4 position = texelFetch(u_position, texel, 0);
    o_light = vec4(0.0);
    if (index >= u_extent || position.w < 0.0) {
        return;
    }
    Look look = lookOf(texelFetch(u_birth, texel, 0), u_now);
    if (look.lit == 0.0) {
        return;
    }
    uint seed = uint(index) * 9781u + 6271u;
    noise(seed);
    vec3 up = vec3(0.0, 1.0, 0.0);
    vec3 start = position.xyz + (1.5 * u_texel + 0.25 * look.size) * up;
    float sun;
    vec3 above;
    receive(start, up, seed, sun, above);
    o_light = vec4(sun, above);
}
