// Particles as point sprites: vertex i fetches particle i from the state textures, nothing is read back.
// With RELIEF_LIT the collider shades them; else they lie in the open.
#ifdef RELIEF_LIT
//!include collider.glsl
//!include light.glsl
#endif

uniform highp sampler2D u_position;
uniform highp sampler2D u_birth;
uniform int u_width;
uniform float u_now;
uniform mat4 u_view;
uniform mat4 u_projection;
uniform float u_pixels_per_unit;  // pixels of a unit length at view distance 1
uniform float u_diameter;         // object units
uniform vec2 u_pixels;            // least and largest sprite
uniform vec2 u_fade;              // seconds of fading in after birth and out before death
uniform float u_opacity;

flat out vec3 v_sun;   // what a grain receives from the sun, and from above and below
flat out vec3 v_above;
flat out vec3 v_below;
flat out float v_alpha;
flat out float v_pixels;

void main() {
    ivec2 texel = ivec2(gl_VertexID % u_width, gl_VertexID / u_width);
    vec4 position = texelFetch(u_position, texel, 0);
    vec4 birth = texelFetch(u_birth, texel, 0);
    if (position.w < 0.0) {  // dead: beyond the far plane
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
        gl_PointSize = 1.0;
        v_alpha = 0.0;
        v_pixels = 1.0;
        v_sun = v_above = v_below = vec3(0.0);
        return;
    }
    // The depth is that of the grain's front, so that grains on a surface are not half sunk into it; the place
    // on the picture that of its centre.
    vec4 in_view = u_view * vec4(position.xyz, 1.0);
    gl_Position = u_projection * in_view;
    float distance = max(-in_view.z, 1e-6);
    vec4 front = u_projection * vec4(in_view.xyz * max(1.0 - 0.5 * u_diameter / distance, 0.05), 1.0);
    gl_Position.z = front.z / front.w * gl_Position.w;

    // Below the least size a sprite keeps its light by losing opacity instead.
    float wanted = u_diameter * u_pixels_per_unit / distance;
    v_pixels = clamp(wanted, u_pixels.x, u_pixels.y);
    gl_PointSize = v_pixels;
    float cover = min(wanted / v_pixels, 1.0);
    float age = u_now - birth.x;
    float left = birth.y - u_now;
    float fade = clamp(age / max(u_fade.x, 1e-6), 0.0, 1.0) * clamp(left / max(u_fade.y, 1e-6), 0.0, 1.0);
    v_alpha = u_opacity * fade * cover * cover;

#ifdef RELIEF_LIT
    uint seed = uint(gl_VertexID) * 9781u + 6271u;
    noise(seed);
    vec3 up = vec3(0.0, 1.0, 0.0);
    vec3 start = position.xyz + (1.5 * u_texel + 0.25 * u_diameter) * up;
    float sun;
    receive(start, up, seed, sun, v_above);
    v_sun = SUN_COLOR * sun;
    v_below = FLOOR_COLOR;
#else
    v_sun = vec3(1.02, 0.97, 0.88);
    v_above = vec3(0.40, 0.46, 0.56);
    v_below = vec3(0.25, 0.26, 0.28);
#endif
}
